#include "jobs/bench/report.h"

#include <cstdio>
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
                       {"share_of_peak", result.share_of_peak(f)},
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
      {"share_of_peak", result.share_of_peak(result.figure("lanes"))},
      {"peak_flops_per_s", result.peak},
      {"bytes_per_case", result.pipeline ? Json(result.pipeline->bytes_per_case) : Json()},
      {"seconds_to_prepare_case", result.seconds_to_prepare},
      {"pipeline", result.pipeline ? make_json(*result.pipeline) : Json()},
      {"machine", make_json(result.machine)}};
}

template <class... Values>
void print_line(std::ostream& stream, const char* format, Values... values) {
  char line[256];
  std::snprintf(line, sizeof line, format, values...);
  stream << line << "\n";
}

}  // namespace

void print_table(std::ostream& stream, const BenchResult& result,
                 const std::vector<FigureRatio>& ratios) {
  const Machine& machine = result.machine;
  print_line(stream, "%s, %d cores, %s, %s, %s\n", machine.cpu.c_str(), machine.cores,
             machine.isa.c_str(), machine.compiler.c_str(), machine.commit.c_str());
  print_line(stream, "%-16s %10s %9s %12s %12s %8s %6s  %s", "one core", "runs/s", "x double",
             "x real time", "error [1]", "of peak", "spin", "setting");
  for (const Figure& f : result.single_core) {
    print_line(stream, "%-16s %10.1f %9.2f %12.1f %12.2e %7.1f%% %6.2f  %s",
               f.setting.label.c_str(), f.runs_per_s, result.speedup_over_double(f),
               f.real_time_factor, f.error, 100.0 * result.share_of_peak(f), f.spin_control,
               f.setting.text.c_str());
  }
  print_line(stream, "\n%-16s %10s %12s %19s", "threads", "runs/s", "speedup",
             "spin of one thread");
  for (const ThreadFigure& t : result.threads) {
    print_line(stream, "%-16d %10.1f %12.2f %19.2f", t.threads, t.runs_per_s,
               t.runs_per_s / result.threads.front().runs_per_s, t.spin_control);
  }
  print_line(
      stream,
      "\nerror: body acceleration, rms over the run, relative to CVODE at 1e-12; worst lane");
  print_line(stream, "spin: a fixed loop timed beside, 1 on this machine when nobody else uses it");
  print_line(stream,
             "right-hand side: %ld operations closed by Newton, %ld tabulated; %ld, %ld calls of "
             "sin, cos, atan, exp",
             result.newton.arithmetic, result.table.arithmetic, result.newton.transcendental,
             result.table.transcendental);
  print_line(stream,
             "peak of one core: %.1f Gflop/s; preparing a case (trim): %.3f ms, not in the above",
             1e-9 * result.peak, 1e3 * result.seconds_to_prepare);
  if (result.pipeline) print_pipeline(stream, *result.pipeline);
  if (ratios.empty()) return;
  print_line(stream, "\n%-16s %10s", "new / old", "ratio");
  for (const FigureRatio& r : ratios) print_line(stream, "%-16s %10.3f", r.name.c_str(), r.ratio);
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
    throw InputError("--baseline: " + std::string(e.what()) +
                     "; must be a file written by strut bench --json");
  }
  if (!baseline.is_object() || !baseline.contains("single_core")) {
    throw InputError("--baseline = " + path +
                     ": no \"single_core\" in it; must be a file written by strut bench --json");
  }
  return baseline;
}

namespace {

/// The member of an object; null where there is none.
const Json& get_member(const Json& json, const std::string& key) {
  static const Json kNone;
  if (!json.is_object()) return kNone;
  const auto found = json.find(key);
  return found == json.end() ? kNone : *found;
}

}  // namespace

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
      add(std::to_string(t.threads) + " threads", get_member(old, "runs_per_s"), t.runs_per_s);
    }
  }
  const Json& runs = get_member(get_member(baseline, "pipeline"), "runs");
  const auto sweeps = result.pipeline ? result.pipeline->figures : std::vector<PipelineFigure>();
  for (const PipelineFigure& f : sweeps) {
    for (const Json& old : runs) {
      if (get_member(old, "isa") != f.isa || get_member(old, "threads") != f.threads) continue;
      add("sweep, " + f.isa + ", " + std::to_string(f.threads) + " threads",
          get_member(old, "runs_per_s"), f.runs_per_s);
    }
  }
  add("flops_per_rhs", get_member(baseline, "flops_per_rhs"),
      static_cast<double>(result.newton.arithmetic));
  return ratios;
}

}  // namespace strut
