#include "jobs/identify/plate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "base/math/normal.h"
#include "identify/fit.h"
#include "identify/history.h"
#include "identify/plate.h"
#include "jobs/cli/command.h"
#include "jobs/cli/messages.h"
#include "jobs/cli/output_file.h"
#include "jobs/cli/progress.h"
#include "jobs/cli/settings.h"
#include "jobs/identify/columns.h"
#include "jobs/identify/result.h"
#include "model_files/parameters.h"
#include "model_files/read_rig.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

PlateRecord read_plate_record(const Arguments& arguments, const fs::path& file) {
  using C = QuarterCarChannel;
  std::vector<ColumnInfo> columns;
  for (const int channel : {C::kRoadPosition, C::kTireForce}) {
    const ChannelInfo& info =
        get_rig_info(RigKind::kQuarterCar).channels[static_cast<std::size_t>(channel)];
    columns.push_back({info.name, info.unit, info.description});
  }
  const Measurement history = read_history(file, columns, read_columns_option(arguments, columns));
  require_ascending_times(history);
  return {file.string(), history.values(kTimeColumn), history.values(columns[0].name),
          history.values(columns[1].name)};
}

/// A figure of the stand: its key in JSON, unit and number.
struct NamedFigure {
  const char* name;
  const char* unit;
  PlateFigure figure;
};

std::vector<NamedFigure> list_figures(const PlateFigures& bench, const LehrDamping& lehr) {
  return {{"eusama_percent", "%", bench.eusama},
          {"phase_angle", "degrees", bench.phase_angle},
          {"lehr_damping", "1", lehr.body},
          {"lehr_damping_wheel", "1", lehr.wheel}};
}

IdentifiedParameter make_parameter_of(const NamedFigure& f) {
  return {f.name, f.unit, f.figure.value, kNormal95 * f.figure.sigma, true};
}

Json make_bench_json(const std::vector<NamedFigure>& figures, const PlateFigures& bench) {
  Json json = Json::object();
  for (const NamedFigure& f : figures) {
    const IdentifiedParameter p = make_parameter_of(f);
    Json one = Json::object();
    add_estimate_json(p, one);
    one["frequency"] = f.figure.frequency;
    json[f.name] = one;
  }
  json["static_load"] = bench.static_load;
  json["at_wheel_mode"] = bench.at_wheel_mode;
  return json;
}

void print_notes(const PlateFigures& bench, const FitResult& fit) {
  print_note(fmt::format("lowest contact force at {:.3g} Hz, lowest phase at {:.3g} Hz{}",
                         bench.eusama.frequency, bench.phase_angle.frequency,
                         bench.at_wheel_mode ? ", the upper end of its band" : ""));
  if (bench.eusama.value == 0.0) print_note("the tire lifts off the plate");
  if (!fit.converged) print_error("the fit has not converged: no interval of a parameter is valid");
  if (!fit.is_adequate()) {
    print_note(
        fmt::format("the simulated force deviates by {:.3g} times the noise: the corner is not a "
                    "linear quarter car; `strut diagnose` names what it lacks",
                    std::sqrt(fit.chi2_per_degree())));
  }
}

}  // namespace

bool is_plate_test(const Arguments& arguments, const fs::path& model) {
  return !arguments.has("maneuver") && model.extension() == ".toml" &&
         find_rig_kind(model) == RigKind::kQuarterCar;
}

int identify_by_plate(const Arguments& arguments, const fs::path& path,
                      const std::vector<fs::path>& files) {
  for (const char* name : {"free", "channels", "window", "prior", "noise", "event-time"}) {
    if (arguments.has(name)) throw InputError(fmt::format("--{}: not for a wheel plate", name));
  }
  if (files.size() != 1) {
    throw arguments.usage_error(
        "MEASURED: must be one record with time, road_position, tire_force");
  }
  RigSpec rig = read_rig(path);
  for (const std::string& setting : arguments.list("set")) {
    name_option("set", [&] { apply_rig_setting(rig, setting); });
  }
  const PlateRecord record = read_plate_record(arguments, files.front());
  const std::vector<PlateResponse> responses = calc_plate_responses(record);
  const double load = calc_static_load(record);
  const int threads = static_cast<int>(arguments.integer_or("threads", 1, 1, 1024));
  // A record without noise would give the readings infinite weight.
  const double noise = std::max(calc_plate_noise(responses), 1e-6 * load);
  const FitResult fit = [&] {
    const ProgressLine line("fitting the simulation to the plate");
    return fit_plate(record, rig, load, noise, threads);
  }();
  const PlateFigures bench = calc_plate_figures(responses, load, calc_phase_band(fit), record.name);
  IdentifiedRow row;
  for (std::size_t i = 0; i < kPlateParameters; ++i) {
    row.parameters.push_back(make_estimate(fit, i));
    row.parameters.back().half_width = kNormal95 * fit.widened.sigma[i];
  }
  const std::vector<NamedFigure> figures = list_figures(bench, calc_lehr_damping(fit));
  Json json = make_identified_json({row});
  json["bench"] = make_bench_json(figures, bench);
  json["converged"] = fit.converged;
  json["chi2_per_dof"] = fit.chi2_per_degree();
  for (const NamedFigure& f : figures) row.parameters.push_back(make_parameter_of(f));
  if (arguments.has("output")) {
    write_identified_csv(find_output_file(arguments, arguments.positional()), {row});
  }
  if (arguments.is_on("json")) {
    std::cout << format_json(json) << "\n";
  } else {
    print_identified({row});
  }
  print_notes(bench, fit);
  suggest_next({"strut", "compare", "CAMPAIGN.toml", "-o", "comparison"},
               "to compare the record with this rig");
  return fit.converged && row.in_range() ? kExitDone : kExitNegative;
}

}  // namespace strut
