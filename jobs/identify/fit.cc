#include "jobs/identify/fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <optional>

#include "identify/fit.h"
#include "jobs/cli/command.h"
#include "jobs/cli/messages.h"
#include "jobs/cli/output_file.h"
#include "jobs/cli/progress.h"
#include "jobs/compare/check.h"
#include "jobs/identify/fit_input.h"
#include "jobs/identify/fit_report.h"
#include "jobs/identify/result.h"
#include "jobs/identify/wear.h"
#include "model_files/read_model.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

void require_fit_arguments(const Arguments& arguments, const fs::path& vehicle,
                           const std::vector<fs::path>& files) {
  if (arguments.has("event-time")) {
    throw InputError("--event-time: allowed with a model's snapshot only");
  }
  if (arguments.is_on("extrapolate")) throw InputError("--extrapolate: allowed with a model only");
  if (read_model_info(vehicle).is_driven_by_inputs()) {
    throw InputError(
        fmt::format("{}: is a rig; identify fits cars only, `strut compare` calibrates rigs",
                    vehicle.string()));
  }
  if (files.empty())
    throw arguments.usage_error(
        "MEASURED: missing; name a history with a column time and the --channels");
  if (!arguments.has("maneuver"))
    throw arguments.usage_error(
        "--maneuver: missing; give the file of the maneuver that was driven");
}

/// The file of --output, checked before the fit; none without that option.
std::optional<fs::path> find_table_file(const Arguments& arguments) {
  if (!arguments.has("output")) return std::nullopt;
  std::vector<std::string> inputs = arguments.positional();
  for (const char* option : {"maneuver", "before"}) {
    for (const std::string& file : arguments.list(option)) inputs.push_back(file);
  }
  return find_output_file(arguments, inputs);
}

void suggest_after_fit(const Arguments& arguments, const fs::path& vehicle, const FitResult& fit,
                       const IdentifiedRow& row) {
  if (!row.in_range()) {
    suggest_next({"strut", "design", "SWEEP.toml"},
                 "channels and instants that determine the open parameters");
  } else if (fit.converged && fit.is_adequate()) {
    suggest_next_simulation({row}, vehicle.string(), arguments.list("maneuver").front());
  } else {
    suggest_next({"strut", "compare", "CAMPAIGN.toml", "-o", "comparison"},
                 "where and when the model deviates from the channels");
  }
}

/// Fits the unknowns that the options choose to `runs`; `what` names them for the progress.
Fit fit_runs(const Arguments& arguments, std::vector<MeasuredRun> runs, const char* what) {
  const FitUnknowns unknowns = make_unknowns(arguments, runs);
  FitOptions options;
  options.linearize.threads = static_cast<int>(arguments.integer_or("threads", 1, 1, 1024));
  print_detail(
      fmt::format("{} unknowns, {} threads", unknowns.all.size(), options.linearize.threads));
  report_findings(check_recordings(runs, unknowns.all, options.linearize.threads));
  const Stage stage("fit");
  const ProgressLine line(fmt::format("fitting the simulation to {} {}", runs.size(), what));
  FitResult result = fit_simulation(runs, unknowns.all, options);
  return {std::move(runs), std::move(result), unknowns.parameter_count};
}

/// Whether a fit determines its parameters: converged, all in range, none held by a bound.
bool is_determined(const Fit& fit, const IdentifiedRow& row) {
  const std::vector<bool>& held = fit.result.at_bound;
  return fit.result.converged && row.in_range() &&
         std::find(held.begin(), held.end(), true) == held.end();
}

}  // namespace

void add_fit_options(Arguments& arguments) {
  arguments.add_list("maneuver", ArgumentValue::file("FILE", {"toml"}),
                     "fit: the maneuver that was driven; one for all measured files or, repeated, "
                     "one for each");
  arguments.add_option("free", "NAME,...", "fit: parameters to identify (default: as --by axle)");
  arguments.add_option("by", ArgumentValue::one_of({"axle", "corner"}),
                       "fit: identify stiffness and damping of each axle (default) or corner");
  arguments.add_option("channels", "NAME,...",
                       "fit: columns to compare (default imu_acceleration_z,imu_rate_y)");
  arguments.add_option("window", "FROM:TO", "fit: use the readings between these times [s] only");
  arguments.add_list("nuisance", "NAME=MEAN,SIGMA",
                     "fit: free a parameter that is not known exactly, as the load, a tire's\n"
                     "stiffness or the height of the bump, with this prior");
  arguments.add_list("prior", "NAME=MEAN,SIGMA",
                     "fit: prior knowledge of a free parameter, speed, hit_time or\n"
                     "CHANNEL_bias");
  arguments.add_switch("no-nuisances", "fit: take hit time, speed and sensor biases as exact");
  arguments.add_option("threads", "N", "fit: threads (default 1)");
}

void refuse_fit_options(const Arguments& arguments) {
  const auto refuse = [](const char* name) {
    throw InputError(fmt::format("--{}: allowed with VEHICLE.toml only", name));
  };
  for (const char* name :
       {"maneuver", "free", "by", "channels", "window", "nuisance", "prior", "threads"}) {
    if (arguments.has(name)) refuse(name);
  }
  if (arguments.is_on("no-nuisances")) refuse("no-nuisances");
}

int identify_by_fit(const Arguments& arguments, const fs::path& vehicle,
                    const std::vector<fs::path>& files) {
  require_fit_arguments(arguments, vehicle, files);
  const std::optional<fs::path> output = find_table_file(arguments);
  const std::vector<fs::path> earlier = list_before(arguments);
  std::vector<fs::path> all = files;
  all.insert(all.end(), earlier.begin(), earlier.end());
  std::vector<MeasuredRun> runs = read_runs(arguments, vehicle, all);
  const auto first_earlier = runs.begin() + static_cast<std::ptrdiff_t>(files.size());
  std::vector<MeasuredRun> runs_before(first_earlier, runs.end());
  runs.erase(first_earlier, runs.end());

  const Fit fit = fit_runs(arguments, std::move(runs), "runs");
  IdentifiedRow row = make_fit_row(fit.result, fit.parameter_count);
  std::optional<Fit> before;
  std::vector<IdentifiedRow> rows_before;
  if (!runs_before.empty()) {
    before = fit_runs(arguments, std::move(runs_before), "earlier runs");
    rows_before = {make_fit_row(before->result, before->parameter_count)};
  }
  row = add_wear_by_options(arguments, vehicle, {row}, rows_before).front();
  if (output) write_identified_csv(*output, {row});
  if (arguments.is_on("json")) {
    Json json = make_fit_json(fit, row);
    if (before) json["before"] = make_fit_json(*before, rows_before.front());
    std::cout << format_json(json) << "\n";
  } else {
    print_fit(fit, row);
    if (before) {
      print_note("the earlier measurement:");
      report_fit(*before);
    }
  }
  suggest_after_fit(arguments, vehicle, fit.result, row);
  const bool determined =
      is_determined(fit, row) && (!before || is_determined(*before, rows_before.front()));
  return determined ? kExitDone : kExitNegative;
}

}  // namespace strut
