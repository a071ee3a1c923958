#include "jobs/bench.h"

#include <omp.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <mutex>
#include <optional>

#include "base/parallel/team.h"
#include "base/text/quote_word.h"
#include "jobs/bench/find_example.h"
#include "jobs/bench/report.h"
#include "jobs/cli/arguments.h"
#include "jobs/cli/command.h"
#include "jobs/cli/interrupt.h"
#include "jobs/cli/machine.h"
#include "jobs/cli/messages.h"
#include "jobs/cli/open_sweep.h"
#include "jobs/cli/progress.h"

namespace strut {
namespace {

/// Body acceleration rms error up to which a setting counts as exact.
constexpr double kAllowedError = 1e-3;
/// How long to measure.
struct Effort {
  double seconds = 0.25;  // a repeat
  int repeats = 6;
};

/// What is to be measured.
struct BenchRequest {
  CaseSource source;
  const Kernel* kernel = nullptr;
  bool quick = false;
  std::filesystem::path sweep;  // the request of one; empty: none is run
  std::filesystem::path scratch;
};

/// Best of several repeats, each of whole runs for about effort.seconds.
Figure measure(const BenchCases& bench, const Kernel& kernel, const BenchSetting& setting,
               const Effort& effort, double best_spin) {
  Figure figure{setting};
  const int cases = setting.in_lanes ? kernel.lanes : 1;
  for (int repeat = 0; repeat < effort.repeats; ++repeat) {
    const double spin_before = measure_spin(), start = now();
    long runs = 0, derivatives = 0;
    do {
      derivatives += cases * run_cases(bench, kernel, setting, {}).derivative_count;
      runs += cases;
    } while (now() - start < effort.seconds);
    const double seconds = now() - start;
    const double rate = static_cast<double>(runs) / seconds;
    if (rate <= figure.runs_per_s) continue;
    figure.runs_per_s = rate;
    figure.rhs_per_s = static_cast<double>(derivatives) / seconds;
    figure.spin_control = 0.5 * (spin_before + measure_spin()) / best_spin;
  }
  figure.real_time_factor = bench.duration * figure.runs_per_s;
  return figure;
}

/// The candidate that is exact and, in short trials, fastest.
BenchSetting find_fastest(const BenchCases& bench, const Kernel& kernel, bool quick) {
  BenchSetting best = list_standard_settings().back();
  double best_rate = 0.0;
  for (const BenchSetting& setting : list_fast_settings(quick)) {
    if (!(measure_error(bench, kernel, setting) <= kAllowedError)) continue;
    const double rate = measure(bench, kernel, setting, {0.02, 3}, 1.0).runs_per_s;
    if (rate > best_rate) best_rate = rate, best = setting;
  }
  return best;
}

/// Every thread runs its own batches for `seconds`; all spin at once before and after.
ThreadFigure measure_threads(const BenchCases& bench, const Kernel& kernel,
                             const BenchSetting& setting, int threads, double seconds,
                             double best_spin) {
  const double before = measure_spins(threads);
  double rate = 0.0;
  check_team(threads);
#pragma omp parallel num_threads(threads) reduction(+ : rate)
  {
    run_cases(bench, kernel, setting, {});  // wakes the thread and its memory
#pragma omp barrier
    const double start = now();
    long runs = 0;
    do {
      run_cases(bench, kernel, setting, {});
      runs += kernel.lanes;
    } while (now() - start < seconds);
    rate += static_cast<double>(runs) / (now() - start);
  }
  return {threads, rate, 0.5 * (before + measure_spins(threads)) / best_spin};
}

/// What is being measured, and the share of it that is done.
class BenchProgress {
 public:
  explicit BenchProgress(std::size_t total)
      : total_(total), line_([this, start = now()] { return describe(now() - start); }) {}

  void begin(const std::string& doing) {
    print_detail(doing);
    const std::lock_guard lock(mutex_);
    doing_ = doing;
    ++begun_;
  }

 private:
  std::string describe(double seconds) {
    const std::lock_guard lock(mutex_);
    return std::to_string(begun_) + "/" + std::to_string(total_) + ": " + doing_ + ", " +
           format_duration(seconds);
  }

  const std::size_t total_;
  std::mutex mutex_;
  std::string doing_;
  std::size_t begun_ = 0;
  ProgressLine line_;  // last: it asks for the others from a thread of its own
};

/// Once `halt` is true it ends soon, its figures no figures.
BenchResult run_benchmark(const BenchRequest& request, std::atomic<bool>& halt) {
  const Kernel& kernel = *request.kernel;
  const bool quick = request.quick;
  const Effort effort = quick ? Effort{0.05, 2} : Effort{};
  BenchResult result;
  result.machine = read_machine(kernel);
  BenchProgress progress(list_standard_settings().size() +
                         static_cast<std::size_t>(result.machine.cores) +
                         (request.sweep.empty() ? 2 : 3));
  progress.begin("preparing " + std::to_string(kernel.lanes) + " cases and their references");
  const BenchCases bench = make_bench_cases(request.source, kernel.lanes);
  result.seconds_to_prepare = bench.seconds_to_prepare;
  const double spin = calibrate_spin();
  result.peak = measure_peak(kernel);
  result.newton = count_flops(bench.cases[0], Closure::kNewton);
  result.table = count_flops(bench.cases[0], Closure::kTable);

  for (const BenchSetting& setting : list_standard_settings()) {
    if (halt) return result;
    progress.begin("measuring " + std::string(setting.label));
    result.single_core.push_back(measure(bench, kernel, setting, effort, spin));
    result.single_core.back().error = measure_error(bench, kernel, setting);
  }
  if (halt) return result;
  progress.begin("searching the fastest setting");
  BenchSetting fastest = find_fastest(bench, kernel, quick);
  fastest.label = "fastest";
  Figure figure = measure(bench, kernel, fastest, effort, spin);
  figure.error = measure_error(bench, kernel, fastest);
  result.single_core.push_back(figure);

  for (int threads = 1; threads <= result.machine.cores; ++threads) {
    if (halt) return result;
    progress.begin("measuring " + std::to_string(threads) + " threads");
    ThreadFigure best;
    for (int repeat = 0; repeat < std::max(2, effort.repeats / 2); ++repeat) {
      const ThreadFigure f = measure_threads(bench, kernel, fastest, threads, effort.seconds, spin);
      if (f.runs_per_s > best.runs_per_s) best = f;
    }
    result.threads.push_back(best);
  }
  if (halt || request.sweep.empty()) return result;
  progress.begin("measuring a sweep");
  result.pipeline = measure_pipeline(request.sweep, quick ? 320 : 2000, result.machine.cores, spin,
                                     request.scratch, halt);
  return result;
}

/// The example that is swept; none, and told, where a car was named and there are no examples.
std::filesystem::path find_sweep(bool must) {
  const char* const name = "sweeps/paper_fast.toml";
  try {
    return find_example(name);
  } catch (const InputError&) {
    if (must) throw;
  }
  print_note("examples/" + std::string(name) +
             ": not found above the program or the working directory; no sweep is measured");
  return {};
}

std::filesystem::path find_scratch(const Arguments& arguments) {
  if (!arguments.has("scratch")) return std::filesystem::temp_directory_path();
  std::filesystem::path scratch = arguments.text("scratch");
  std::error_code ignored;
  if (!std::filesystem::is_directory(scratch, ignored)) {
    throw InputError("--scratch = " + scratch.string() + ": must be a folder");
  }
  if (::access(scratch.c_str(), W_OK) != 0) {
    throw EnvironmentError("--scratch = " + scratch.string() + ": " + std::strerror(errno));
  }
  return scratch;
}

BenchRequest read_request(const Arguments& arguments) {
  const auto& files = arguments.positional();
  if (!files.empty() && files.size() != 2) {
    throw arguments.usage_error(std::to_string(files.size()) +
                                " files; expected VEHICLE and MANEUVER, or none");
  }
  BenchRequest request;
  const bool is_named = !files.empty();
  request.source.vehicle =
      is_named ? std::filesystem::path(files[0]) : find_example("vehicles/paper_sedan.toml");
  request.source.maneuver =
      is_named ? std::filesystem::path(files[1]) : find_example("maneuvers/bump_20mps.toml");
  request.kernel = &find_kernel(arguments);
  request.quick = arguments.is_on("quick");
  request.sweep = find_sweep(!is_named);
  request.scratch = find_scratch(arguments);
  return request;
}

/// The same measurement, as words of a shell.
std::string name_again(const Arguments& arguments) {
  std::string line = "strut bench";
  for (const std::string& file : arguments.positional()) line += " " + quote_if_needed(file);
  if (arguments.has("isa")) line += " --isa " + quote_if_needed(arguments.text("isa"));
  if (arguments.is_on("quick")) line += " --quick";
  return line;
}

void suggest_next_step(const Arguments& arguments) {
  const std::string again = name_again(arguments);
  if (arguments.has("baseline")) {
    suggest_next_line(again + " --json > new.json", "a baseline for later; docs/performance.md");
  } else if (arguments.is_on("json")) {
    suggest_next_line(again + " --baseline OLD.json", "this output, in a file");
  } else {
    suggest_next_line(again + " --json > old.json", "then the same with --baseline old.json");
  }
}

}  // namespace

Arguments describe_bench() {
  Arguments arguments(
      "strut bench [VEHICLE MANEUVER] [OPTIONS]",
      "Measures how many runs a second this machine simulates on one core and on all, and how\n"
      "exactly. Without files: examples/vehicles/paper_sedan.toml over\n"
      "examples/maneuvers/bump_20mps.toml, springs and dampers spread over the paper's ranges. "
      "Then\n"
      "runs a sweep of examples/sweeps/paper_fast.toml, where it is found, from plan to shards.",
      "  strut bench --json > old.json\n  strut bench --baseline old.json");
  arguments.add_operand(ArgumentValue::file("VEHICLE", {"toml"}));
  arguments.add_operand(ArgumentValue::file("MANEUVER", {"toml"}));
  arguments.add_switch("json", "print JSON instead of a table");
  arguments.add_option("baseline", ArgumentValue::file("FILE", {"json"}),
                       "print each figure relative to this output of --json");
  arguments.add_option("isa", isa_value(),
                       "instruction set, one that --version lists (default: widest)");
  arguments.add_option("scratch", ArgumentValue::folder("DIR"),
                       "where the sweep's files go for a moment (default: the system's temporary "
                       "folder)");
  arguments.add_switch("quick", "a tenth of the time, rougher figures");
  return arguments;
}

int run_bench(const Arguments& arguments) {
  const BenchRequest request = read_request(arguments);
  std::optional<Baseline> baseline;
  if (arguments.has("baseline")) baseline = read_baseline(arguments.text("baseline"));

  // Before the threads of OpenMP are there: one of them would end the program amid a sweep.
  InterruptWatcher watcher;
  const BenchResult result = run_benchmark(request, watcher.halt());
  if (watcher.signal() != 0) {
    print_error("interrupted");
    suggest_again(arguments, "starts over");
    return 128 + watcher.signal();
  }
  const std::vector<FigureRatio> ratios =
      baseline ? compare(result, *baseline) : std::vector<FigureRatio>{};
  arguments.is_on("json") ? print_json(std::cout, result, ratios)
                          : print_table(std::cout, result, ratios);
  suggest_next_step(arguments);
  return kExitDone;
}

}  // namespace strut
