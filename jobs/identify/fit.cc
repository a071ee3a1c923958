#include "jobs/identify/fit.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <optional>

#include "base/text/format_number.h"
#include "base/text/nearest_name.h"
#include "base/text/parse_number.h"
#include "estimate/fit.h"
#include "estimate/nuisances.h"
#include "io/store/measurement.h"
#include "jobs/case/load_case.h"
#include "jobs/cli/command.h"
#include "jobs/cli/lists.h"
#include "jobs/cli/messages.h"
#include "jobs/cli/output_file.h"
#include "jobs/cli/progress.h"
#include "jobs/identify/fit_report.h"
#include "model_files/find_channel.h"
#include "model_files/parameters.h"
#include "model_files/read_model.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

constexpr char kTime[] = "time";
constexpr char kForVehicle[] = ": allowed with VEHICLE.toml only";

/// Calls `function`; an InputError of it names the option it came from.
template <class Function>
auto name_option(const std::string& option, const Function& function) {
  try {
    return function();
  } catch (const InputError& e) {
    throw InputError("--" + option + ": " + e.what());
  }
}

double read_number(const std::string& text, const std::string& what) {
  const auto value = parse_number<double>(text);
  if (value && std::isfinite(*value)) return *value;
  throw InputError(what + " = '" + text + "': must be a number");
}

std::vector<int> read_channels(const Arguments& arguments) {
  if (!arguments.has("channels")) return {CarChannel::kImuAccelerationZ, CarChannel::kImuRateY};
  std::vector<int> channels;
  for (const std::string& name : split_list(arguments.text("channels"))) {
    const int channel = name_option("channels", [&] { return find_car_channel(name); });
    if (channel == CarChannel::kTime)
      throw InputError("--channels: time is the abscissa; name what was measured at it");
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
    throw InputError("--channels: no noise is known for " + name + "; give --noise " + name +
                     "=SIGMA");
  }
  return noise;
}

/// FROM:TO in seconds.
std::pair<double, double> read_window(const Arguments& arguments) {
  const std::string text = arguments.text("window");
  const auto colon = text.find(':');
  if (colon == std::string::npos) throw InputError("--window = " + text + ": must be FROM:TO");
  const double from = read_number(text.substr(0, colon), "--window: FROM");
  const double to = read_number(text.substr(colon + 1), "--window: TO");
  if (!(from < to)) throw InputError("--window = " + text + ": FROM must be below TO");
  return {from, to};
}

/// Time and channels of one file, in their units.
Measurement read_history(const fs::path& file, const std::vector<int>& channels) {
  std::vector<ColumnInfo> columns = {{kTime, "s", ""}};
  MeasurementRequest request{{kTime}, {}, MeasuredPart::kHistory};
  for (const int c : channels) {
    const ChannelInfo& info = list_car_channels()[static_cast<std::size_t>(c)];
    columns.push_back({info.name, info.unit, info.description});
    request.required.push_back(info.name);
  }
  Measurement measurement = read_measurement(file, request);
  require_units(measurement, columns);
  return measurement;
}

/// A sensor that works has noise; a simulation whose channel rests has none.
void tell_constant(const MeasuredRun& run) {
  for (const MeasuredChannel& c : run.channels) {
    const double first = c.values.front();
    const bool constant = std::all_of(c.values.begin(), c.values.end(),
                                      [first](double value) { return value == first; });
    if (!constant || c.values.size() < 2) continue;
    print_note(run.name + ": " + list_car_channels()[static_cast<std::size_t>(c.channel)].name +
               " is " + format_number(first) + " in all " + std::to_string(c.values.size()) +
               " readings: does its sensor work?");
  }
}

MeasuredRun read_run(const Arguments& arguments, const fs::path& file, const Case& setup,
                     const std::vector<int>& channels, const SensorNoise& noise) {
  const Measurement measurement = read_history(file, channels);
  MeasuredRun run{file.string(), setup, measurement.values(kTime), {}};
  for (const int c : channels) {
    const auto at = static_cast<std::size_t>(c);
    run.channels.push_back({c, noise[at], measurement.values(list_car_channels()[at].name)});
  }
  check_measured_run(run);
  const double first = run.times.front(), last = run.times.back();
  if (arguments.has("window")) {
    const auto [from, to] = read_window(arguments);
    cut_window(run, from, to);
  }
  if (run.times.empty())
    throw InputError("--window: no sample of " + run.name + " lies in it; its times are " +
                     format_number(first) + " to " + format_number(last) + " s");
  tell_constant(run);
  return run;
}

std::vector<MeasuredRun> read_runs(const Arguments& arguments, const fs::path& vehicle,
                                   const std::vector<fs::path>& files) {
  const std::vector<std::string> maneuvers = arguments.list("maneuver");
  if (maneuvers.size() != 1 && maneuvers.size() != files.size()) {
    throw arguments.usage_error("--maneuver: " + std::to_string(maneuvers.size()) + " for " +
                                std::to_string(files.size()) +
                                " measured files; allowed: one for all, or one for each");
  }
  const std::vector<int> channels = read_channels(arguments);
  const SensorNoise noise = read_noise(arguments, channels);
  std::vector<MeasuredRun> runs;
  runs.reserve(files.size());
  for (std::size_t i = 0; i < files.size(); ++i) {
    const std::string& maneuver = maneuvers[maneuvers.size() == 1 ? 0 : i];
    const CaseSource source{vehicle, maneuver, arguments.list("set")};
    const Case setup = load_case(source);
    prepare_case(source, setup);  // a car that cannot stand is told by its file
    runs.push_back(read_run(arguments, files[i], setup, channels, noise));
  }
  return runs;
}

/// The speed belongs to each run, everything else to the car and the road.
std::vector<Unknown> make_free(const Arguments& arguments, const std::vector<MeasuredRun>& runs) {
  const std::string text = arguments.has("free")
                               ? arguments.text("free")
                               : "front_stiffness,front_damping,rear_stiffness,rear_damping";
  std::vector<Unknown> unknowns;
  for (const std::string& name : split_list(text)) {
    if (name != "speed") {
      unknowns.push_back(name_option("free", [&] { return make_parameter(runs, name); }));
      continue;
    }
    for (std::size_t run = 0; run < runs.size(); ++run) {
      unknowns.push_back(make_parameter(runs, name, static_cast<int>(run)));
    }
  }
  name_option("free", [&] { check_unknowns(unknowns, runs.size()); });
  return unknowns;
}

/// "name=mean,sigma"
std::pair<std::string, Prior> parse_prior(const std::string& setting) {
  const auto equals = setting.find('='), comma = setting.find(',', equals);
  if (equals == std::string::npos || comma == std::string::npos) {
    throw InputError("--prior: '" + setting + "': must be NAME=MEAN,SIGMA, as speed=20,0.1");
  }
  const std::string name = setting.substr(0, equals);
  const Prior prior{read_number(setting.substr(equals + 1, comma - equals - 1), "--prior: mean"),
                    read_number(setting.substr(comma + 1), "--prior: sigma")};
  if (!(prior.sigma > 0.0)) throw InputError("--prior: '" + setting + "': sigma must be > 0");
  return {name, prior};
}

void apply_prior(const ModelInfo& model, const std::string& setting,
                 std::vector<Unknown>& unknowns) {
  const auto [name, prior] = parse_prior(setting);
  std::vector<std::string> names;
  bool found = false;
  for (Unknown& u : unknowns) {
    names.push_back(u.name);
    if (u.name != name) continue;
    found = true;
    if (u.kind == UnknownKind::kHitTime) {
      u = make_hit_time(u.run, prior);
    } else if (u.kind == UnknownKind::kBias) {
      u = make_bias(model, u.run, u.channel, prior);
    } else {
      u.prior = prior;
      u.start = std::clamp(prior.mean, u.low, u.high);
    }
  }
  if (found) return;
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  throw InputError("--prior: '" + name + "' is not free; free: " + join_names(names) +
                   suggest_name(name, names));
}

void require_fit_arguments(const Arguments& arguments, const fs::path& vehicle,
                           const std::vector<fs::path>& files) {
  if (arguments.has("event-time")) {
    throw InputError("--event-time: allowed with a model's snapshot only");
  }
  if (arguments.is_on("extrapolate")) throw InputError("--extrapolate: allowed with a model only");
  if (read_model_info(vehicle).is_driven_by_inputs()) {
    throw InputError(vehicle.string() +
                     ": is a rig; identify fits cars only, `strut compare` calibrates rigs");
  }
  if (files.empty())
    throw arguments.usage_error(
        "MEASURED: missing; name a history with a column time and the --channels");
  if (!arguments.has("maneuver"))
    throw arguments.usage_error("--maneuver: missing; give the file of what was driven");
}

/// Where --output goes, so that a fit is not made in vain; none without that option.
std::optional<fs::path> find_table_file(const Arguments& arguments) {
  if (!arguments.has("output")) return std::nullopt;
  std::vector<std::string> inputs = arguments.positional();
  for (const std::string& maneuver : arguments.list("maneuver")) inputs.push_back(maneuver);
  return find_output_file(arguments, inputs);
}

}  // namespace

void add_fit_options(Arguments& arguments) {
  arguments.add_list("maneuver", ArgumentValue::file("FILE", {"toml"}),
                     "fit: what was driven; one for all measured files or, repeated, one\n"
                     "each");
  arguments.add_option("free", "NAME,...",
                       "fit: parameters to find (default: stiffness and damping of both axles)");
  arguments.add_option("channels", "NAME,...",
                       "fit: columns to compare (default imu_acceleration_z,imu_rate_y)");
  arguments.add_option("window", "FROM:TO", "fit: only what was measured in between [s]");
  arguments.add_list("prior", "NAME=MEAN,SIGMA",
                     "fit: what is known of a free parameter, speed, hit_time or\n"
                     "CHANNEL_bias");
  arguments.add_switch("no-nuisances", "fit: hit time, speed and sensors' biases are exact");
  arguments.add_option("threads", "N", "fit: threads (default 1)");
}

void refuse_fit_options(const Arguments& arguments) {
  for (const char* name : {"maneuver", "free", "channels", "window", "prior", "threads"}) {
    if (arguments.has(name)) throw InputError(std::string("--") + name + kForVehicle);
  }
  if (arguments.is_on("no-nuisances"))
    throw InputError(std::string("--no-nuisances") + kForVehicle);
}

int identify_by_fit(const Arguments& arguments, const fs::path& vehicle,
                    const std::vector<fs::path>& files) {
  require_fit_arguments(arguments, vehicle, files);
  const std::optional<fs::path> output = find_table_file(arguments);
  const std::vector<MeasuredRun> runs = read_runs(arguments, vehicle, files);
  std::vector<Unknown> unknowns = make_free(arguments, runs);
  const std::size_t parameter_count = unknowns.size();
  if (!arguments.is_on("no-nuisances")) {
    for (Unknown& u : make_nuisances(runs, {}, unknowns)) unknowns.push_back(std::move(u));
  }
  for (const std::string& setting : arguments.list("prior")) {
    apply_prior(runs.front().setup.info(), setting, unknowns);
  }
  FitOptions options;
  options.linearize.threads = static_cast<int>(arguments.integer_or("threads", 1, 1, 1024));
  print_detail(std::to_string(unknowns.size()) + " unknowns, " +
               std::to_string(options.linearize.threads) + " threads");
  const FitResult fit = [&] {
    const Stage stage("fit");
    const ProgressLine line("fitting the simulation to " + std::to_string(runs.size()) + " runs");
    return fit_simulation(runs, unknowns, options);
  }();

  const IdentifiedRow row = make_fit_row(fit, parameter_count);
  if (output) write_identified_csv(*output, {row});
  if (arguments.is_on("json")) {
    std::cout << format_json(make_fit_json(fit, runs, parameter_count)) << "\n";
  } else {
    print_fit(fit, runs, parameter_count);
  }
  const bool held = std::find(fit.at_bound.begin(), fit.at_bound.end(), true) != fit.at_bound.end();
  if (!row.in_range()) {
    suggest_next({"strut", "design", "SWEEP.toml"},
                 "which channels and instants tell what is open");
  } else if (fit.converged && fit.is_adequate()) {
    suggest_next_simulation({row}, vehicle.string(), arguments.list("maneuver").front());
  } else {
    suggest_next({"strut", "compare", "CAMPAIGN.toml", "-o", "comparison"},
                 "which channel the model gets wrong, and when");
  }
  return fit.converged && row.in_range() && !held ? kExitDone : kExitNegative;
}

}  // namespace strut
