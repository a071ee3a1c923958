#include "jobs/bench/report.h"

#include <fmt/format.h>

#include <ostream>

#include "base/error/input_error.h"
#include "io/file/read_text_file.h"

namespace strut {
namespace {

Json make_json(const BenchResult& result) {
  Json single = Json::object();
  for (const Figure& f : result.single_core) {
    Json figure = Json{{"runs_per_s", f.runs_per_s},
                       {"real_time_factor", f.real_time_factor},
                       {"setting", f.setting.text},
                       {"body_acceleration_rms_relative", f.error},
                       {"share_of_peak", result.fraction_of_peak(f)},
                       {"spin_control", f.spin_control}};
    if (f.setting.label == "lanes") {
      figure["speedup_over_double"] = result.speedup_over_double(f);
    }
    single[f.setting.label] = figure;
  }
  Json threads = Json::array();
  for (const ThreadFigure& t : result.threads) {
    threads.push_back(Json{
        {"threads", t.threads}, {"runs_per_s", t.runs_per_s}, {"spin_control", t.spin_control}});
  }
  return Json{
      {"single_core", single},
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
  stream << fmt::format("{:<16} {:>10} {:>9} {:>12} {:>12} {:>8} {:>6}  {}\n", "one core", "runs/s",
                        "x double", "x real time", "error [1]", "of peak", "spin", "setting");
  for (const Figure& f : result.single_core) {
    stream << fmt::format("{:<16} {:>10.1f} {:>9.2f} {:>12.1f} {:>12.2e} {:>7.1f}% {:>6.2f}  {}\n",
                          f.setting.label, f.runs_per_s, result.speedup_over_double(f),
                          f.real_time_factor, f.error, 100.0 * result.fraction_of_peak(f),
                          f.spin_control, f.setting.text);
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

void print_explanations(std::ostream& stream, const BenchResult& result) {
  const FlopCount &newton = result.newton, &table = result.table;
  stream
      << "\nerror: rms of the body acceleration's error over the run, relative to CVODE at 1e-12; "
         "worst lane\n"
         "spin: speed of a fixed loop timed at the same time; 1: nobody else uses this machine\n";
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
  stream << fmt::format("{}, {} cores, {}, {}, {}\n\n", machine.cpu, machine.cores, machine.isa,
                        machine.compiler, machine.commit);
  print_single_core(stream, result);
  print_threads(stream, result);
  print_explanations(stream, result);
  if (result.pipeline) print_pipeline(stream, *result.pipeline);
  if (ratios.empty()) return;
  stream << fmt::format("\n{:<16} {:>10}\n", "new / old", "ratio");
  for (const FigureRatio& r : ratios) stream << fmt::format("{:<16} {:>10.3f}\n", r.name, r.ratio);
}

void print_json(std::ostream& stream, const BenchResult& result,
                const std::vector<FigureRatio>& ratios) {
  Json json = make_json(result);
  if (!ratios.empty()) {
    Json members = Json::object();
    for (const FigureRatio& r : ratios) members[r.name] = r.ratio;
    json["ratios"] = members;
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

std::vector<FigureRatio> compare(const BenchResult& result, const Baseline& baseline) {
  std::vector<FigureRatio> ratios;
  const auto add = [&](const std::string& name, const Json& old, double value) {
    if (old.is_number() && old > 0.0) ratios.push_back({name, value / old.get<double>()});
  };
  const Json& single = get_member(baseline, "single_core");
  for (const Figure& f : result.single_core) {
    const std::string& label = f.setting.label;
    add(label, get_member(get_member(single, label), "runs_per_s"), f.runs_per_s);
  }
  for (const ThreadFigure& t : result.threads) {
    for (const Json& old : get_member(baseline, "threads")) {
      if (get_member(old, "threads") != t.threads) continue;
      add(fmt::format("{} threads", t.threads), get_member(old, "runs_per_s"), t.runs_per_s);
    }
  }
  const Json& runs = get_member(get_member(baseline, "pipeline"), "runs");
  const auto sweeps = result.pipeline ? result.pipeline->figures : std::vector<PipelineFigure>();
  for (const PipelineFigure& f : sweeps) {
    for (const Json& old : runs) {
      if (get_member(old, "isa") != f.isa || get_member(old, "threads") != f.threads) continue;
      add(fmt::format("sweep, {}, {} threads", f.isa, f.threads), get_member(old, "runs_per_s"),
          f.runs_per_s);
    }
  }
  add("flops_per_rhs", get_member(baseline, "flops_per_rhs"),
      static_cast<double>(result.newton.arithmetic));
  return ratios;
}

}  // namespace strut
