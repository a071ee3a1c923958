#include "jobs/bench/measure.h"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <limits>
#include <mutex>

#include "base/parallel/team.h"
#include "jobs/bench/instructions.h"
#include "jobs/cli/clock.h"
#include "jobs/cli/messages.h"
#include "jobs/cli/progress.h"

namespace strut {
namespace {

/// Maximum error, as of measure_error(), of the fastest setting.
constexpr double kMaxError = 1e-3;

/// Duration and number of repeats of one measurement.
struct Effort {
  double seconds = 0.25;  // duration of a repeat
  int repeats = 6;
};

/// Measures the best of several repeats, each of whole runs for about effort.seconds.
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
  figure.rhs_per_run = count_right_hand_sides(bench, kernel, setting);
  figure.flops_per_run =
      figure.rhs_per_run *
      static_cast<double>(count_flops(bench.cases[0], setting.options).arithmetic);
  const auto instructions = count_instructions([&] { run_cases(bench, kernel, setting, {}); });
  if (instructions) figure.instructions_per_run = *instructions / cases;
  figure.error = measure_error(bench, kernel, setting);
  return figure;
}

/// Measures all candidates in short trials. Returns early once `halt` is true.
std::vector<Figure> measure_candidates(const BenchCases& bench, const Kernel& kernel, bool quick,
                                       double best_spin, const std::atomic<bool>& halt) {
  std::vector<Figure> figures;
  for (const BenchSetting& setting : list_fast_settings(quick)) {
    if (halt) break;
    figures.push_back(measure(bench, kernel, setting, {0.02, 2}, best_spin));
  }
  return figures;
}

/// The setting that is accurate enough and has the fewest operations, so that no other program
/// decides.
BenchSetting find_fastest(const std::vector<Figure>& candidates) {
  BenchSetting best = list_standard_settings().back();
  double least = std::numeric_limits<double>::infinity();
  for (const Figure& f : candidates) {
    if (!(f.error <= kMaxError) || f.flops_per_run >= least) continue;
    least = f.flops_per_run;
    best = f.setting;
  }
  return best;
}

/// Every thread runs its own batches for `seconds`; before and after, all measure their spin rate.
ThreadFigure measure_threads(const BenchCases& bench, const Kernel& kernel,
                             const BenchSetting& setting, int threads, double seconds,
                             double best_spin) {
  const double before = measure_spins(threads);
  double rate = 0.0;
  check_team(threads);
#pragma omp parallel num_threads(threads) reduction(+ : rate)
  {
    run_cases(bench, kernel, setting, {});  // starts the thread and touches its memory
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

/// A progress line: which of `total` measurements is running.
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
    return fmt::format("{}/{}: {}, {}", begun_, total_, doing_, format_duration(seconds));
  }

  const std::size_t total_;
  std::mutex mutex_;
  std::string doing_;
  std::size_t begun_ = 0;
  ProgressLine line_;  // last member: its thread reads the others
};

/// The standard settings, then the fastest, on one core. Returns early once `halt` is true.
void measure_single_core(const BenchCases& bench, const BenchRequest& request, const Effort& effort,
                         double spin, const std::atomic<bool>& halt, BenchProgress& progress,
                         BenchResult& result) {
  const Kernel& kernel = *request.kernel;
  const auto add = [&](const BenchSetting& setting) {
    result.single_core.push_back(measure(bench, kernel, setting, effort, spin));
  };
  for (const BenchSetting& setting : list_standard_settings()) {
    if (halt) return;
    progress.begin("measuring " + setting.label);
    add(setting);
  }
  if (halt) return;
  progress.begin("searching for the fastest setting");
  result.candidates = measure_candidates(bench, kernel, request.quick, spin, halt);
  BenchSetting fastest = find_fastest(result.candidates);
  BenchSetting both_sides = fastest;
  both_sides.options.symmetry = false;
  both_sides.label = "fastest_both_sides";
  both_sides.text = describe(both_sides.options);
  add(both_sides);
  fastest.label = "fastest";
  add(fastest);
}

/// The fastest setting on 1 to all cores. Returns early once `halt` is true.
void measure_all_cores(const BenchCases& bench, const BenchRequest& request, const Effort& effort,
                       double spin, const std::atomic<bool>& halt, BenchProgress& progress,
                       BenchResult& result) {
  const BenchSetting& fastest = result.single_core.back().setting;
  for (int threads = 1; threads <= result.machine.cores; ++threads) {
    if (halt) return;
    progress.begin(fmt::format("measuring {} threads", threads));
    ThreadFigure best;
    for (int repeat = 0; repeat < std::max(2, effort.repeats / 2); ++repeat) {
      const ThreadFigure f =
          measure_threads(bench, *request.kernel, fastest, threads, effort.seconds, spin);
      if (f.runs_per_s > best.runs_per_s) best = f;
    }
    result.threads.push_back(best);
  }
}

}  // namespace

BenchResult run_benchmark(const BenchRequest& request, std::atomic<bool>& halt) {
  const Kernel& kernel = *request.kernel;
  const Effort effort = request.quick ? Effort{0.05, 2} : Effort{};
  BenchResult result;
  result.machine = read_machine(kernel);
  BenchProgress progress(list_standard_settings().size() +
                         static_cast<std::size_t>(result.machine.cores) +
                         (request.sweep.empty() ? 2 : 3));
  progress.begin(fmt::format("preparing {} cases and their references", kernel.lanes));
  const BenchCases bench = make_bench_cases(request.source, kernel.lanes);
  result.seconds_to_prepare = bench.seconds_to_prepare;
  const double spin = calibrate_spin();
  result.peak = measure_peak(kernel);
  IntegrateOptions whole;
  result.newton = count_flops(bench.cases[0], whole);
  whole.closure = Closure::kTable;
  result.table = count_flops(bench.cases[0], whole);

  measure_single_core(bench, request, effort, spin, halt, progress, result);
  if (halt) return result;
  measure_all_cores(bench, request, effort, spin, halt, progress, result);
  if (halt || request.sweep.empty()) return result;
  progress.begin("measuring a sweep");
  result.pipeline = measure_pipeline(request.sweep, request.quick ? 320 : 2000,
                                     result.machine.cores, spin, request.scratch, halt);
  return result;
}

}  // namespace strut
