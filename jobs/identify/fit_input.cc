#include "jobs/identify/fit_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include "base/text/format_number.h"
#include "base/text/parse_number.h"
#include "estimate/nuisances.h"
#include "identify/fit.h"
#include "identify/run.h"
#include "identify/wear.h"
#include "jobs/case/load_case.h"
#include "jobs/cli/lists.h"
#include "jobs/cli/messages.h"
#include "jobs/cli/settings.h"
#include "jobs/identify/columns.h"
#include "model_files/find_channel.h"

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

/// The parameters to identify: those of --free, or the springs and dampers of all axles or corners.
std::vector<std::string> list_free(const Arguments& arguments) {
  if (!arguments.has("free")) {
    return list_wear_parameters(static_cast<WearLocations>(arguments.choice_or("by", 0)));
  }
  if (arguments.has("by")) {
    throw arguments.usage_error("--by chooses what is free: give it or --free, not both");
  }
  return split_list(arguments.text("free"));
}

/// Adds the nuisance of NAME=MEAN,SIGMA.
void add_nuisance_setting(const std::vector<MeasuredRun>& runs, const std::string& setting,
                          FitUnknowns& unknowns) {
  const auto [name, prior] = parse_prior(setting);
  const auto parameters_end =
      unknowns.all.begin() + static_cast<std::ptrdiff_t>(unknowns.parameter_count);
  if (std::any_of(unknowns.all.begin(), parameters_end,
                  [&, &name = name](const Unknown& u) { return u.name == name; })) {
    throw InputError(fmt::format("'{}' is identified; --prior gives it a prior", name));
  }
  add_nuisance(runs, name, prior, unknowns.all);
}

}  // namespace

std::vector<MeasuredRun> read_runs(const Arguments& arguments, const fs::path& vehicle,
                                   const std::vector<fs::path>& files) {
  const std::vector<std::string> maneuvers = arguments.list("maneuver");
  if (maneuvers.size() != 1 && maneuvers.size() != files.size()) {
    throw arguments.usage_error(fmt::format(
        "--maneuver: {} for {} measured files; allowed: one for all, or one for each, those of "
        "--before last",
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

FitUnknowns make_unknowns(const Arguments& arguments, const std::vector<MeasuredRun>& runs) {
  FitUnknowns unknowns;
  const std::vector<std::string> free = list_free(arguments);
  unknowns.all = name_option("free", [&] { return make_free_unknowns(runs, free); });
  unknowns.parameter_count = unknowns.all.size();
  if (!arguments.is_on("no-nuisances")) {
    for (Unknown& u : make_nuisances(runs, {}, unknowns.all)) unknowns.all.push_back(std::move(u));
  }
  for (const std::string& setting : arguments.list("nuisance")) {
    name_option("nuisance", [&] { add_nuisance_setting(runs, setting, unknowns); });
  }
  for (const std::string& setting : arguments.list("prior")) {
    name_option("prior", [&] {
      const auto [name, prior] = parse_prior(setting);
      set_prior(runs.front().setup.info(), name, prior, unknowns.all);
    });
  }
  return unknowns;
}

}  // namespace strut
