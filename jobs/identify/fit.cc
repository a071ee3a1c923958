#include "jobs/identify/fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <optional>

#include "base/text/format_number.h"
#include "base/text/parse_number.h"
#include "estimate/nuisances.h"
#include "identify/fit.h"
#include "identify/run.h"
#include "jobs/case/load_case.h"
#include "jobs/cli/command.h"
#include "jobs/cli/lists.h"
#include "jobs/cli/messages.h"
#include "jobs/cli/output_file.h"
#include "jobs/cli/progress.h"
#include "jobs/cli/settings.h"
#include "jobs/compare/check.h"
#include "jobs/identify/columns.h"
#include "jobs/identify/fit_report.h"
#include "jobs/identify/result.h"
#include "model_files/find_channel.h"
#include "model_files/read_model.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

std::vector<int> read_channels(const Arguments& arguments) {
  if (!arguments.has("channels")) return {CarChannel::kImuAccelerationZ, CarChannel::kImuRateY};
  std::vector<int> channels;
  for (const std::string& name : split_list(arguments.text("channels"))) {
    const int channel = name_option("channels", [&] { return find_car_channel(name); });
    if (channel == CarChannel::kTime)
      throw InputError("--channels: time is the abscissa; name the channels measured over it");
    channels.push_back(channel);
  }
  if (channels.empty()) throw InputError("--channels: empty; allowed: names of channels");
  return channels;
}

SensorNoise read_noise(const Arguments& arguments, const std::vector<int>& channels) {
  SensorNoise noise = make_default_noise();
  for (const std::string& setting : arguments.list("noise")) {
    name_option("noise", [&] { apply_noise(noise, setting); });
  }
  for (const int channel : channels) {
    if (noise[static_cast<std::size_t>(channel)] > 0.0) continue;
    const std::string& name = list_car_channels()[static_cast<std::size_t>(channel)].name;
    throw InputError(
        fmt::format("--channels: {0} has no default noise; give --noise {0}=SIGMA", name));
  }
  return noise;
}

void keep_window_of(const Arguments& arguments, MeasuredRun& run) {
  if (!arguments.has("window")) return;
  const auto [from, to] = read_time_range(arguments, "window");
  if (!(from < to)) {
    throw InputError(fmt::format("--window = {}: FROM must be below TO", arguments.text("window")));
  }
  name_option("window", [&, first = from, last = to] { keep_window(run, first, last); });
}

void note_constant_channels(const MeasuredRun& run) {
  for (const std::size_t c : find_constant_channels(run)) {
    const MeasuredChannel& channel = run.channels[c];
    print_note(fmt::format("{}: {} is {} in all {} readings: does its sensor work?", run.name,
                           list_car_channels()[static_cast<std::size_t>(channel.channel)].name,
                           format_number(channel.values.front()), channel.values.size()));
  }
}

std::vector<MeasuredRun> read_runs(const Arguments& arguments, const fs::path& vehicle,
                                   const std::vector<fs::path>& files) {
  const std::vector<std::string> maneuvers = arguments.list("maneuver");
  if (maneuvers.size() != 1 && maneuvers.size() != files.size()) {
    throw arguments.usage_error(
        fmt::format("--maneuver: {} for {} measured files; allowed: one for all, or one for each",
                    maneuvers.size(), files.size()));
  }
  const std::vector<int> channels = read_channels(arguments);
  const SensorNoise noise = read_noise(arguments, channels);
  const ColumnMap map = read_columns_option(arguments, list_columns(channels));
  std::vector<MeasuredRun> runs;
  runs.reserve(files.size());
  for (std::size_t i = 0; i < files.size(); ++i) {
    const CaseSource source{vehicle, maneuvers[maneuvers.size() == 1 ? 0 : i],
                            arguments.list("set")};
    const Case setup = load_case(source);
    prepare_case(source, setup);  // names the file of a car that cannot stand
    runs.push_back(read_measured_run(files[i], setup, channels, noise, map));
    keep_window_of(arguments, runs.back());
    note_constant_channels(runs.back());
  }
  return runs;
}

/// Reads NAME=MEAN,SIGMA.
std::pair<std::string, Prior> parse_prior(const std::string& setting) {
  const auto equals = setting.find('='), comma = setting.find(',', equals);
  if (equals == std::string::npos || comma == std::string::npos) {
    throw InputError(fmt::format("'{}': must be NAME=MEAN,SIGMA, as speed=20,0.1", setting));
  }
  const auto read = [&](const std::string& text) {
    const auto value = parse_number<double>(text);
    if (value && std::isfinite(*value)) return *value;
    throw InputError(fmt::format("'{}': '{}' must be a number", setting, text));
  };
  const Prior prior{read(setting.substr(equals + 1, comma - equals - 1)),
                    read(setting.substr(comma + 1))};
  if (!(prior.sigma > 0.0)) throw InputError(fmt::format("'{}': sigma must be > 0", setting));
  return {setting.substr(0, equals), prior};
}

/// The unknowns of a fit, the parameters first.
struct FitUnknowns {
  std::vector<Unknown> all;
  std::size_t parameter_count = 0;
};

FitUnknowns make_unknowns(const Arguments& arguments, const std::vector<MeasuredRun>& runs) {
  const std::vector<std::string> names =
      arguments.has("free") ? split_list(arguments.text("free")) : list_default_free_parameters();
  FitUnknowns unknowns;
  unknowns.all = name_option("free", [&] { return make_free_unknowns(runs, names); });
  unknowns.parameter_count = unknowns.all.size();
  if (!arguments.is_on("no-nuisances")) {
    for (Unknown& u : make_nuisances(runs, {}, unknowns.all)) unknowns.all.push_back(std::move(u));
  }
  for (const std::string& setting : arguments.list("prior")) {
    name_option("prior", [&] {
      const auto [name, prior] = parse_prior(setting);
      set_prior(runs.front().setup.info(), name, prior, unknowns.all);
    });
  }
  return unknowns;
}

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
  for (const std::string& maneuver : arguments.list("maneuver")) inputs.push_back(maneuver);
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

}  // namespace

void add_fit_options(Arguments& arguments) {
  arguments.add_list("maneuver", ArgumentValue::file("FILE", {"toml"}),
                     "fit: the maneuver that was driven; one for all measured files or, repeated, "
                     "one for each");
  arguments.add_option(
      "free", "NAME,...",
      "fit: parameters to identify (default: stiffness and damping of both axles)");
  arguments.add_option("channels", "NAME,...",
                       "fit: columns to compare (default imu_acceleration_z,imu_rate_y)");
  arguments.add_option("window", "FROM:TO", "fit: use the readings between these times [s] only");
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
  for (const char* name : {"maneuver", "free", "channels", "window", "prior", "threads"}) {
    if (arguments.has(name)) refuse(name);
  }
  if (arguments.is_on("no-nuisances")) refuse("no-nuisances");
}

int identify_by_fit(const Arguments& arguments, const fs::path& vehicle,
                    const std::vector<fs::path>& files) {
  require_fit_arguments(arguments, vehicle, files);
  const std::optional<fs::path> output = find_table_file(arguments);
  const std::vector<MeasuredRun> runs = read_runs(arguments, vehicle, files);
  const FitUnknowns unknowns = make_unknowns(arguments, runs);
  FitOptions options;
  options.linearize.threads = static_cast<int>(arguments.integer_or("threads", 1, 1, 1024));
  print_detail(
      fmt::format("{} unknowns, {} threads", unknowns.all.size(), options.linearize.threads));
  report_findings(check_recordings(runs, unknowns.all, options.linearize.threads));
  const FitResult fit = [&] {
    const Stage stage("fit");
    const ProgressLine line(fmt::format("fitting the simulation to {} runs", runs.size()));
    return fit_simulation(runs, unknowns.all, options);
  }();
  const IdentifiedRow row = make_fit_row(fit, unknowns.parameter_count);
  if (output) write_identified_csv(*output, {row});
  if (arguments.is_on("json")) {
    std::cout << format_json(make_fit_json(fit, runs, unknowns.parameter_count)) << "\n";
  } else {
    print_fit(fit, runs, unknowns.parameter_count);
  }
  suggest_after_fit(arguments, vehicle, fit, row);
  const bool held = std::find(fit.at_bound.begin(), fit.at_bound.end(), true) != fit.at_bound.end();
  return fit.converged && row.in_range() && !held ? kExitDone : kExitNegative;
}

}  // namespace strut
