#include "jobs/bench/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <ostream>

#include "base/error/input_error.h"
#include "io/file/read_text_file.h"
#include "jobs/cli/progress.h"

namespace strut {
namespace {

constexpr char kRhsPerRun[] = "rhs_per_run", kFlopsPerRun[] = "flops_per_run",
               kInstructionsPerRun[] = "instructions_per_run";

Json make_json(const Figure& f) {
  return Json{
      {"runs_per_s", f.runs_per_s},
      {"real_time_factor", f.real_time_factor},
      {"setting", f.setting.text},
      {"body_acceleration_rms_relative", f.error},
      {"spin_control", f.spin_control},
      {kRhsPerRun, f.rhs_per_run},
      {kFlopsPerRun, f.flops_per_run},
      {kInstructionsPerRun, f.instructions_per_run ? Json(*f.instructions_per_run) : Json()}};
}

Json make_json(const BenchResult& result) {
  Json single = Json::object();
  for (const Figure& f : result.single_core) {
    Json figure = make_json(f);
    figure["share_of_peak"] = result.fraction_of_peak(f);
    if (f.setting.label == "lanes") {
      figure["speedup_over_double"] = result.speedup_over_double(f);
    }
    single[f.setting.label] = figure;
  }
  Json candidates = Json::array();
  for (const Figure& f : result.candidates) candidates.push_back(make_json(f));
  Json threads = Json::array();
  for (const ThreadFigure& t : result.threads) {
    threads.push_back(Json{
        {"threads", t.threads}, {"runs_per_s", t.runs_per_s}, {"spin_control", t.spin_control}});
  }
  return Json{
      {"single_core", single},
      {"work_precision", candidates},
      {"threads", threads},
      {"accuracy", Json{{"body_acceleration_rms_relative", result.single_core.back().error}}},
      {"flops_per_rhs", result.newton.arithmetic},
      {"flops_per_rhs_tabulated", result.table.arithmetic},
      {"transcendentals_per_rhs", result.newton.transcendental},
      {"share_of_peak", result.fraction_of_peak(result.figure("lanes"))},
      {"peak_flops_per_s", result.peak},
      {"bytes_per_case", result.pipeline ? Json(result.pipeline->bytes_per_case) : Json()},
      {"seconds_to_prepare_case", result.seconds_to_prepare},
      {"pipeline", result.pipeline ? make_json(*result.pipeline) : Json()},
      {"machine", make_json(result.machine)}};
}

/// The member of an object; null if there is none.
const Json& get_member(const Json& json, const std::string& key) {
  static const Json kNone;
  if (!json.is_object()) return kNone;
  const auto found = json.find(key);
  return found == json.end() ? kNone : *found;
}

void print_single_core(std::ostream& stream, const BenchResult& result) {
  stream << fmt::format("{:<18} {:>8} {:>8} {:>11} {:>9} {:>7} {:>5} {:>8} {:>9} {:>7}  {}\n",
                        "one core", "runs/s", "x double", "x real time", "error [1]", "of peak",
                        "spin", "rhs/run", "Mflop/run", "M instr", "setting");
  for (const Figure& f : result.single_core) {
    const std::string instructions =
        f.instructions_per_run ? fmt::format("{:.2f}", 1e-6 * *f.instructions_per_run) : "-";
    stream << fmt::format(
        "{:<18} {:>8.1f} {:>8.2f} {:>11.1f} {:>9.2e} {:>6.1f}% {:>5.2f} {:>8.0f} {:>9.2f} {:>7}  "
        "{}\n",
        f.setting.label, f.runs_per_s, result.speedup_over_double(f), f.real_time_factor, f.error,
        100.0 * result.fraction_of_peak(f), f.spin_control, f.rhs_per_run, 1e-6 * f.flops_per_run,
        instructions, f.setting.text);
  }
}

/// The settings that no other beats in both error and operations, from the most accurate on.
void print_work_precision(std::ostream& stream, const BenchResult& result) {
  std::vector<Figure> sorted = result.candidates;
  std::sort(sorted.begin(), sorted.end(),
            [](const Figure& a, const Figure& b) { return a.flops_per_run < b.flops_per_run; });
  stream << fmt::format("\n{:<18} {:>8} {:>9} {:>9}  {}\n", "work over error", "runs/s",
                        "Mflop/run", "error [1]", "setting");
  double least = std::numeric_limits<double>::infinity();
  for (const Figure& f : sorted) {
    if (!(f.error < least)) continue;
    least = f.error;
    stream << fmt::format("{:<18} {:>8.1f} {:>9.2f} {:>9.2e}  {}\n", "", f.runs_per_s,
                          1e-6 * f.flops_per_run, f.error, f.setting.text);
  }
}

void print_threads(std::ostream& stream, const BenchResult& result) {
  stream << fmt::format("\n{:<16} {:>10} {:>12} {:>19}\n", "threads", "runs/s", "speedup",
                        "spin of one thread");
  for (const ThreadFigure& t : result.threads) {
    stream << fmt::format("{:<16} {:>10.1f} {:>12.2f} {:>19.2f}\n", t.threads, t.runs_per_s,
                          t.runs_per_s / result.threads.front().runs_per_s, t.spin_control);
  }
}

void print_ratios(std::ostream& stream, const std::vector<FigureRatio>& ratios) {
  stream << fmt::format("\n{:<44} {:>10} {:>18}\n", "new / old", "ratio", "corrected by spin");
  bool is_all_corrected = true;
  for (const FigureRatio& r : ratios) {
    is_all_corrected = is_all_corrected && (r.is_count || r.corrected);
    stream << fmt::format("{:<44} {:>10.3f} {:>18}\n", r.name, r.ratio,
                          r.is_count    ? "a count"
                          : r.corrected ? fmt::format("{:.3f}", *r.corrected)
                                        : "cannot be");
  }
  if (is_all_corrected) return;
  stream << "cannot be corrected: a measurement without spin control, or below half an undisturbed "
            "core; judge by the counts\n";
}

void print_explanations(std::ostream& stream, const BenchResult& result) {
  const FlopCount &newton = result.newton, &table = result.table;
  stream
      << "\nerror: rms of the body acceleration's error over the run, relative to CVODE at 1e-12; "
         "worst lane\n"
         "spin: speed of a fixed loop timed at the same time; 1: nobody else uses this machine\n"
         "rhs, Mflop, M instr: right-hand sides, 1e6 operations and, where the system counts them, "
         "1e6 "
         "instructions of a run, which depend on no other program\n";
  stream << fmt::format(
      "right-hand side: {} operations closed by Newton, {} tabulated; {}, {} calls of sin, cos, "
      "atan, "
      "exp\n",
      newton.arithmetic, table.arithmetic, newton.transcendental, table.transcendental);
  stream << fmt::format(
      "peak of one core: {:.1f} Gflop/s; preparing a case (trim): {:.3f} ms, not included above\n",
      1e-9 * result.peak, 1e3 * result.seconds_to_prepare);
}

}  // namespace

void print_table(std::ostream& stream, const BenchResult& result,
                 const std::vector<FigureRatio>& ratios) {
  const Machine& machine = result.machine;
  stream << fmt::format("{}, {}, {}, {}, {}\n\n", machine.cpu, format_count(machine.cores, "core"),
                        machine.isa, machine.compiler, machine.commit);
  print_single_core(stream, result);
  print_work_precision(stream, result);
  print_threads(stream, result);
  print_explanations(stream, result);
  if (result.pipeline) print_pipeline(stream, *result.pipeline);
  if (ratios.empty()) return;
  print_ratios(stream, ratios);
}

void print_json(std::ostream& stream, const BenchResult& result,
                const std::vector<FigureRatio>& ratios) {
  Json json = make_json(result);
  if (!ratios.empty()) {
    Json members = Json::object();
    Json corrected = Json::object();
    for (const FigureRatio& r : ratios) {
      members[r.name] = r.ratio;
      if (!r.is_count) corrected[r.name] = r.corrected ? Json(*r.corrected) : Json();
    }
    json["ratios"] = members;
    json["ratios_corrected_by_spin"] = corrected;
  }
  stream << format_json(json) << "\n";
}

Baseline read_baseline(const std::string& path) {
  Baseline baseline;
  try {
    baseline = parse_json(read_text_file(path), path);
  } catch (const InputError& e) {
    throw InputError(
        fmt::format("--baseline: {}; must be a file written by strut bench --json", e.what()));
  }
  if (!baseline.is_object() || !baseline.contains("single_core")) {
    throw InputError(fmt::format(
        "--baseline = {}: has no \"single_core\"; must be a file written by strut bench --json",
        path));
  }
  return baseline;
}

namespace {

/// Spin controls below it are those of a machine that runs something else: speeds then depend on
/// more than the processor's clock.
constexpr double kBusy = 0.5;

/// The ratio of two speeds and, where their spin controls allow it, of the speeds that an
/// undisturbed machine would have.
FigureRatio make_speed_ratio(const std::string& name, double old, double old_spin, double value,
                             double spin) {
  FigureRatio ratio{name, value / old};
  if (old_spin >= kBusy && spin >= kBusy) ratio.corrected = ratio.ratio * old_spin / spin;
  return ratio;
}

/// The number of a member; 0 where there is none.
double get_number(const Json& json, const std::string& key) {
  const Json& member = get_member(json, key);
  return member.is_number() ? member.get<double>() : 0.0;
}

}  // namespace

std::vector<FigureRatio> compare(const BenchResult& result, const Baseline& baseline) {
  std::vector<FigureRatio> ratios;
  const auto add_speed = [&](const std::string& name, const Json& old, double value, double spin,
                             int threads) {
    const double was = get_number(old, "runs_per_s");
    if (!(was > 0.0)) return;
    ratios.push_back(make_speed_ratio(name, was, get_number(old, "spin_control") / threads, value,
                                      spin / threads));
  };
  const auto add_count = [&](const std::string& name, double old, double value) {
    if (old > 0.0) ratios.push_back({name, value / old, {}, true});
  };
  const Json& single = get_member(baseline, "single_core");
  for (const Figure& f : result.single_core) {
    const std::string& label = f.setting.label;
    const Json& old = get_member(single, label);
    add_speed(label, old, f.runs_per_s, f.spin_control, 1);
    add_count(label + ", " + kRhsPerRun, get_number(old, kRhsPerRun), f.rhs_per_run);
    add_count(label + ", " + kFlopsPerRun, get_number(old, kFlopsPerRun), f.flops_per_run);
    if (!f.instructions_per_run) continue;
    add_count(label + ", " + kInstructionsPerRun, get_number(old, kInstructionsPerRun),
              *f.instructions_per_run);
  }
  for (const ThreadFigure& t : result.threads) {
    for (const Json& old : get_member(baseline, "threads")) {
      if (get_member(old, "threads") != t.threads) continue;
      add_speed(fmt::format("{} threads", t.threads), old, t.runs_per_s, t.spin_control, t.threads);
    }
  }
  const Json& runs = get_member(get_member(baseline, "pipeline"), "runs");
  const auto sweeps = result.pipeline ? result.pipeline->figures : std::vector<PipelineFigure>();
  for (const PipelineFigure& f : sweeps) {
    for (const Json& old : runs) {
      if (get_member(old, "isa") != f.isa || get_member(old, "threads") != f.threads) continue;
      add_speed(fmt::format("sweep, {}, {} threads", f.isa, f.threads), old, f.runs_per_s,
                f.spin_control, f.threads);
    }
  }
  add_count("flops_per_rhs", get_number(baseline, "flops_per_rhs"),
            static_cast<double>(result.newton.arithmetic));
  return ratios;
}

}  // namespace strut
