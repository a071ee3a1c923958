#include "study/noise/request.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/text/nearest_name.h"
#include "estimate/nuisances.h"
#include "estimate/sensor_noise.h"
#include "sweep/plan.h"

namespace strut {
namespace {

constexpr int kMaxCopies = 1000, kMaxFits = 100'000;
constexpr double kMinScale = 1e-6, kMaxScale = 1e6;

std::vector<double> read_scales(const Table& table) {
  std::vector<double> scales = table.numbers("scales", between(kMinScale, kMaxScale));
  const bool ascend =
      std::adjacent_find(scales.begin(), scales.end(), std::greater_equal<>()) == scales.end();
  if (scales.empty() || !ascend) {
    throw table.error("scales", "must name at least one factor of the default noise, ascending");
  }
  return scales;
}

void read_window(const Table& table, NoiseStudyRequest& request) {
  const std::vector<double> window = table.numbers("window");
  if (window.size() != 2) throw table.error("window", "must be two times, [from, to] in s");
  request.window.from = window[0];
  request.window.to = window[1];
}

bool has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Both grids vary every identified parameter; that of the windows may also vary the speed, the one
/// axis that a fit treats as a nuisance.
void check_grids(const Table& table, const SweepRequest& snapshots, const SweepRequest& windows) {
  const std::vector<std::string> identified = list_axes(snapshots), axes = list_axes(windows);
  for (const std::string& name : identified) {
    if (has(axes, name)) continue;
    throw table.error("window_sweep",
                      fmt::format("its grid lacks {}, which the study identifies", name));
  }
  for (const std::string& name : axes) {
    if (has(identified, name) || name == kSpeedName) continue;
    throw table.error("window_sweep", fmt::format("its grid varies {}; allowed: {} and {}", name,
                                                  join_names(identified), kSpeedName));
  }
}

void check_sensors(const Table& table, const std::string& key,
                   const std::vector<std::string>& channels) {
  const std::vector<double> noise = take_channels(make_default_noise(), channels);
  for (std::size_t c = 0; c < channels.size(); ++c) {
    if (noise[c] > 0.0) continue;
    throw table.error(key, fmt::format("no default noise of {} is known; docs/identifiability.md "
                                       "lists the channels that have one",
                                       channels[c]));
  }
}

void check_window(const Table& table, const NoiseStudyRequest& request, const SweepRequest& sweep) {
  const ShardSchema schema = Plan(sweep).make_schema();
  const NoiseModel noise = make_window_noise(request, list_history_channels(sweep), 1.0);
  try {
    make_window_grid(schema, request.window, count_spare(schema, noise));
  } catch (const InputError& e) {
    throw table.error("window", e.what());
  }
}

std::vector<std::string> list_channel_names(const std::vector<int>& channels) {
  std::vector<std::string> names;
  names.reserve(channels.size());
  for (const int channel : channels) {
    names.push_back(list_car_channels()[static_cast<std::size_t>(channel)].name);
  }
  return names;
}

}  // namespace

NoiseStudyRequest read_noise_request(const Table& table, const NoiseContext& context) {
  NoiseStudyRequest request;
  request.sweep = table.file("window_sweep");
  read_window(table, request);
  request.scales = read_scales(table);
  request.copies = static_cast<int>(table.integer_or("copies", request.copies, 1, kMaxCopies));
  request.fits = static_cast<int>(table.integer_or("fits", request.fits, 1, kMaxFits));
  request.hit_time = table.number_or("hit_time", request.hit_time, between(1e-6, 1.0, "s"));
  request.network = static_cast<std::size_t>(
      table.choice_or("network", static_cast<int>(context.main_network), context.networks));
  const SweepRequest sweep = read_request(request.sweep);
  if (sweep.history.channels.empty() || sweep.history.rate <= 0.0) {
    throw table.error("window_sweep", "records no histories; must have [record] history");
  }
  check_grids(table, context.sweep, sweep);
  check_sensors(table, "window_sweep", list_history_channels(sweep));
  check_sensors(table, "main inputs", context.inputs);
  if (context.inputs.size() < context.sweep.grid.axes().size()) {
    throw table.error(
        fmt::format("needs at least as many main inputs as there are identified parameters, {}",
                    context.sweep.grid.axes().size()));
  }
  check_window(table, request, sweep);
  return request;
}

std::vector<std::string> list_axes(const SweepRequest& sweep) {
  std::vector<std::string> names;
  names.reserve(sweep.grid.axes().size());
  for (const Axis& axis : sweep.grid.axes()) names.push_back(axis.name);
  return names;
}

std::vector<std::string> list_snapshot_channels(const SweepRequest& sweep) {
  return list_channel_names(sweep.snapshot.channels);
}

std::vector<std::string> list_history_channels(const SweepRequest& sweep) {
  return list_channel_names(sweep.history.channels);
}

NoiseModel make_snapshot_noise(const NoiseStudyRequest& request,
                               const std::vector<std::string>& channels, double scale) {
  NoiseModel noise;
  noise.copies = request.copies;
  noise.sigma = take_channels(make_default_noise(), channels);
  for (double& sigma : noise.sigma) sigma *= scale;
  noise.bias.assign(channels.size(), 0.0);
  return noise;
}

NoiseModel make_window_noise(const NoiseStudyRequest& request,
                             const std::vector<std::string>& channels, double scale) {
  NoiseModel noise = make_snapshot_noise(request, channels, scale);
  noise.bias = take_channels(make_default_bias(), channels);
  noise.hit_time = request.hit_time;
  return noise;
}

}  // namespace strut
