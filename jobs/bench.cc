#include "jobs/bench.h"

#include <omp.h>

#include <algorithm>
#include <boost/property_tree/json_parser.hpp>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <optional>

#include "jobs/arguments.h"
#include "jobs/bench_cases.h"
#include "jobs/command.h"
#include "jobs/count_flops.h"
#include "jobs/find_example.h"
#include "jobs/machine.h"

namespace strut {
namespace {

/// Body acceleration rms error up to which a setting counts as exact.
constexpr double kAllowedError = 1e-3;
/// One case in a data set: number, layer, status, four parameters, five inputs, event time.
constexpr int kBytesPerCase = 13 * 8;

/// How long to measure.
struct Effort {
  double seconds = 0.25;  // a repeat
  int repeats = 6;
};

struct Figure {
  BenchSetting setting;
  double runs_per_s = 0.0;
  double real_time_factor = 0.0;
  double error = 0.0;         // body acceleration rms, relative to CVODE at 1e-12
  double spin_control = 0.0;  // during the best repeat, 1: machine undisturbed
  double rhs_per_s = 0.0;     // right-hand sides a second, of one case each
};

struct ThreadFigure {
  int threads = 1;
  double runs_per_s = 0.0;
  double spin_control = 0.0;  // spins of all threads at once over those of one alone
};

struct BenchResult {
  std::vector<Figure> single_core;
  std::vector<ThreadFigure> threads;
  FlopCount newton, table;
  double peak = 0.0;  // flop/s of one core
  double seconds_to_prepare = 0.0;
  Machine machine;

  const Figure& figure(const std::string& name) const {
    return *std::find_if(single_core.begin(), single_core.end(),
                         [&](const Figure& f) { return f.setting.name == name; });
  }
  double share_of_peak(const Figure& f) const {
    const FlopCount& flops = f.setting.options.closure == Closure::kNewton ? newton : table;
    return static_cast<double>(flops.arithmetic) * f.rhs_per_s / peak;
  }
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

/// Every thread runs its own batches for `seconds`; before, all spin at once.
ThreadFigure measure_threads(const BenchCases& bench, const Kernel& kernel,
                             const BenchSetting& setting, int threads, double seconds,
                             double best_spin) {
  double spins = 0.0, rate = 0.0;
#pragma omp parallel num_threads(threads) reduction(+ : spins, rate)
  {
    run_cases(bench, kernel, setting, {});  // wakes the thread and its memory
#pragma omp barrier
    for (int i = 0; i < 8; ++i) spins += measure_spin() / 8.0;
#pragma omp barrier
    const double start = now();
    long runs = 0;
    do {
      run_cases(bench, kernel, setting, {});
      runs += kernel.lanes;
    } while (now() - start < seconds);
    rate += static_cast<double>(runs) / (now() - start);
  }
  return {threads, rate, spins / best_spin};
}

BenchResult run_benchmark(const CaseSource& source, bool quick) {
  const Kernel& kernel = list_kernels().front();
  const Effort effort = quick ? Effort{0.05, 2} : Effort{};
  BenchResult result;
  result.machine = read_machine(kernel);
  std::cerr << "preparing " << kernel.lanes << " cases and the reference\n";
  const BenchCases bench = make_bench_cases(source, kernel.lanes);
  result.seconds_to_prepare = bench.seconds_to_prepare;
  const double spin = calibrate_spin();
  result.peak = measure_peak(kernel);
  result.newton = count_flops(bench.cases[0], Closure::kNewton);
  result.table = count_flops(bench.cases[0], Closure::kTable);

  for (const BenchSetting& setting : list_standard_settings()) {
    std::cerr << "measuring " << setting.name << "\n";
    result.single_core.push_back(measure(bench, kernel, setting, effort, spin));
    result.single_core.back().error = measure_error(bench, kernel, setting);
  }
  std::cerr << "searching the fastest setting\n";
  BenchSetting fastest = find_fastest(bench, kernel, quick);
  Figure figure = measure(bench, kernel, fastest, effort, spin);
  figure.error = measure_error(bench, kernel, fastest);
  result.single_core.push_back(figure);

  for (int threads = 1; threads <= result.machine.cores; ++threads) {
    std::cerr << "measuring " << threads << " threads\n";
    ThreadFigure best;
    for (int repeat = 0; repeat < std::max(2, effort.repeats / 2); ++repeat) {
      const ThreadFigure f = measure_threads(bench, kernel, fastest, threads, effort.seconds, spin);
      if (f.runs_per_s > best.runs_per_s) best = f;
    }
    result.threads.push_back(best);
  }
  return result;
}

/// "fastest" in files and tables; its setting is told apart.
std::string get_label(const BenchResult& result, std::size_t i) {
  return i + 1 < result.single_core.size() ? result.single_core[i].setting.name : "fastest";
}

std::string describe_setting(const BenchSetting& setting) {
  if (setting.name.find(' ') != std::string::npos) return setting.name;
  return std::string("rk4 1 ms, ") +
         (setting.options.closure == Closure::kNewton ? "newton" : "table") +
         ", exponential spin, events located";
}

Json make_json(const BenchResult& result) {
  Json single = Json::object();
  for (std::size_t i = 0; i < result.single_core.size(); ++i) {
    const Figure& f = result.single_core[i];
    single.set(get_label(result, i), Json::object()
                                         .set("runs_per_s", f.runs_per_s)
                                         .set("real_time_factor", f.real_time_factor)
                                         .set("setting", describe_setting(f.setting))
                                         .set("body_acceleration_rms_relative", f.error)
                                         .set("share_of_peak", result.share_of_peak(f))
                                         .set("spin_control", f.spin_control));
  }
  Json threads = Json::array();
  for (const ThreadFigure& t : result.threads) {
    threads.push(Json::object()
                     .set("threads", t.threads)
                     .set("runs_per_s", t.runs_per_s)
                     .set("spin_control", t.spin_control));
  }
  return Json::object()
      .set("single_core", single)
      .set("threads", threads)
      .set("accuracy",
           Json::object().set("body_acceleration_rms_relative", result.single_core.back().error))
      .set("flops_per_rhs", result.newton.arithmetic)
      .set("flops_per_rhs_tabulated", result.table.arithmetic)
      .set("transcendentals_per_rhs", result.newton.transcendental)
      .set("share_of_peak", result.share_of_peak(result.figure("lanes")))
      .set("peak_flops_per_s", result.peak)
      .set("bytes_per_case", kBytesPerCase)
      .set("seconds_to_prepare_case", result.seconds_to_prepare)
      .set("machine", make_json(result.machine));
}

template <class... Values>
void print_line(const char* format, Values... values) {
  char line[256];
  std::snprintf(line, sizeof line, format, values...);
  std::cout << line << "\n";
}

void print_table(const BenchResult& result) {
  const Machine& machine = result.machine;
  print_line("%s, %d cores, %s, %s, %s\n", machine.cpu.c_str(), machine.cores, machine.isa.c_str(),
             machine.compiler.c_str(), machine.commit.c_str());
  print_line("%-16s %10s %12s %12s %8s %6s  %s", "one core", "runs/s", "x real time", "error [1]",
             "of peak", "spin", "setting");
  for (std::size_t i = 0; i < result.single_core.size(); ++i) {
    const Figure& f = result.single_core[i];
    print_line("%-16s %10.1f %12.1f %12.2e %7.1f%% %6.2f  %s", get_label(result, i).c_str(),
               f.runs_per_s, f.real_time_factor, f.error, 100.0 * result.share_of_peak(f),
               f.spin_control, describe_setting(f.setting).c_str());
  }
  print_line("\n%-16s %10s %12s %19s", "threads", "runs/s", "speedup", "spin of one thread");
  for (const ThreadFigure& t : result.threads) {
    print_line("%-16d %10.1f %12.2f %19.2f", t.threads, t.runs_per_s,
               t.runs_per_s / result.threads.front().runs_per_s, t.spin_control);
  }
  print_line("\nerror: body acceleration, rms over the run, relative to CVODE at 1e-12");
  print_line("spin: a fixed loop timed beside, 1 on this machine when nobody else uses it");
  print_line(
      "right-hand side: %ld operations closed by Newton, %ld tabulated; %ld, %ld calls of "
      "sin, cos, atan, exp",
      result.newton.arithmetic, result.table.arithmetic, result.newton.transcendental,
      result.table.transcendental);
  print_line(
      "peak of one core: %.1f Gflop/s; preparing a case (trim): %.3f ms, not in the above; "
      "a case is %d bytes of data",
      1e-9 * result.peak, 1e3 * result.seconds_to_prepare, kBytesPerCase);
}

using Baseline = boost::property_tree::ptree;

Baseline read_baseline(const std::string& path) {
  Baseline baseline;
  try {
    boost::property_tree::read_json(path, baseline);
  } catch (const boost::property_tree::json_parser_error& e) {
    throw InputError("--baseline = " + path + ": " + e.message() +
                     "; must be a file written by strut bench --json");
  }
  if (!baseline.get_child_optional("single_core")) {
    throw InputError("--baseline = " + path +
                     ": no \"single_core\" in it; must be a file written by strut bench --json");
  }
  return baseline;
}

/// Ratios new/old of every figure both have, as (name, ratio).
std::vector<std::pair<std::string, double>> compare(const BenchResult& result,
                                                    const Baseline& baseline) {
  std::vector<std::pair<std::string, double>> ratios;
  const auto add = [&](const std::string& name, const boost::optional<double>& old, double value) {
    if (old && *old > 0.0) ratios.emplace_back(name, value / *old);
  };
  for (std::size_t i = 0; i < result.single_core.size(); ++i) {
    const std::string label = get_label(result, i);
    add(label, baseline.get_optional<double>("single_core." + label + ".runs_per_s"),
        result.single_core[i].runs_per_s);
  }
  const auto threads = baseline.get_child_optional("threads");
  for (const ThreadFigure& t : result.threads) {
    if (!threads) break;
    for (const auto& [key, old] : *threads) {
      if (old.get("threads", 0) != t.threads) continue;
      add(std::to_string(t.threads) + " threads", old.get_optional<double>("runs_per_s"),
          t.runs_per_s);
    }
  }
  add("flops_per_rhs", baseline.get_optional<double>("flops_per_rhs"),
      static_cast<double>(result.newton.arithmetic));
  return ratios;
}

}  // namespace

int run_bench(const std::vector<std::string>& arguments) {
  Arguments parsed(
      "strut bench [VEHICLE MANEUVER] [OPTIONS]",
      "Measures how many runs a second this machine simulates on one core and on all, and how\n"
      "exactly. Without files: examples/vehicles/paper_sedan.toml over\n"
      "examples/maneuvers/bump_20mps.toml, springs and dampers spread over the paper's ranges.",
      "  strut bench --json > old.json\n  strut bench --baseline old.json");
  parsed.add_switch("json", "print JSON instead of a table");
  parsed.add_option("baseline", "FILE", "print each figure relative to this output of --json");
  parsed.add_switch("quick", "a tenth of the time, rougher figures");
  if (!parsed.parse(arguments)) return kExitDone;
  const auto& files = parsed.positional();
  if (!files.empty() && files.size() != 2) {
    throw parsed.usage_error(std::to_string(files.size()) +
                             " files; expected VEHICLE and MANEUVER, or none");
  }
  CaseSource source;
  source.vehicle = files.empty() ? find_example("vehicles/paper_sedan.toml") : files[0];
  source.maneuver = files.empty() ? find_example("maneuvers/bump_20mps.toml") : files[1];
  std::optional<Baseline> baseline;
  if (parsed.has("baseline")) baseline = read_baseline(parsed.text("baseline"));

  const BenchResult result = run_benchmark(source, parsed.is_on("quick"));
  Json json = make_json(result);
  if (!parsed.is_on("json")) print_table(result);
  if (baseline) {
    Json ratios = Json::object();
    if (!parsed.is_on("json")) print_line("\n%-16s %10s", "new / old", "ratio");
    for (const auto& [name, ratio] : compare(result, *baseline)) {
      if (!parsed.is_on("json")) print_line("%-16s %10.3f", name.c_str(), ratio);
      ratios.set(name, ratio);
    }
    json.set("ratios", ratios);
  }
  if (parsed.is_on("json")) std::cout << json.dump() << "\n";
  return kExitDone;
}

}  // namespace strut
