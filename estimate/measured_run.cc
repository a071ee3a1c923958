#include "estimate/measured_run.h"

#include <algorithm>
#include <cmath>

#include "base/error/input_error.h"
#include "base/text/format_number.h"

namespace strut {
namespace {

const std::string& get_channel_name(const MeasuredRun& run, const MeasuredChannel& channel) {
  return run.setup.info().channels[static_cast<std::size_t>(channel.channel)].name;
}

void check_times(const MeasuredRun& run) {
  for (std::size_t i = 0; i < run.times.size(); ++i) {
    const bool ascends = std::isfinite(run.times[i]) && (i == 0 || run.times[i] > run.times[i - 1]);
    if (ascends) continue;
    throw InputError(run.name + ": time = " + format_number(run.times[i]) + " s in sample " +
                     std::to_string(i + 1) + (i == 0 ? "" : " after ") +
                     (i == 0 ? "" : format_number(run.times[i - 1]) + " s") +
                     ": must be finite and ascend");
  }
}

void check_channel(const MeasuredRun& run, const MeasuredChannel& c) {
  const std::string& name = get_channel_name(run, c);
  const auto same = [&](const MeasuredChannel& other) { return other.channel == c.channel; };
  if (std::count_if(run.channels.begin(), run.channels.end(), same) > 1) {
    throw InputError(run.name + ": channel '" + name + "' twice; allowed: once");
  }
  if (!(c.sigma > 0.0) || !std::isfinite(c.sigma)) {
    throw InputError(run.name + ": noise of " + name + " = " + format_number(c.sigma) +
                     ": must be > 0 and finite");
  }
  if (c.values.size() != run.times.size()) {
    throw InputError(run.name + ": " + name + " has " + std::to_string(c.values.size()) +
                     " readings at " + std::to_string(run.times.size()) + " times");
  }
  const auto bad = std::find_if_not(c.values.begin(), c.values.end(), [&](double v) {
    return std::isfinite(v) || (run.may_miss && std::isnan(v));
  });
  if (bad != c.values.end()) {
    throw InputError(run.name + ": " + name + " in sample " +
                     std::to_string(bad - c.values.begin() + 1) + ": must be a finite number");
  }
}

}  // namespace

void cut_window(MeasuredRun& run, double from, double to) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < run.times.size(); ++i) {
    if (!(run.times[i] >= from && run.times[i] <= to)) continue;
    run.times[kept] = run.times[i];
    for (MeasuredChannel& c : run.channels) c.values[kept] = c.values[i];
    ++kept;
  }
  run.times.resize(kept);
  for (MeasuredChannel& c : run.channels) c.values.resize(kept);
}

void check_measured_run(const MeasuredRun& run) {
  if (run.channels.empty()) throw InputError(run.name + ": no channel to compare");
  check_times(run);
  for (const MeasuredChannel& c : run.channels) check_channel(run, c);
}

MeasuredRun make_planned_run(const Case& setup, const SensorNoise& noise, double rate, double from,
                             double to) {
  MeasuredRun run{"planned measurement", setup, {}, {}};
  const auto count = static_cast<std::size_t>(std::floor((to - from) * rate + 1e-9)) + 1;
  run.times.reserve(count);
  for (std::size_t i = 0; i < count; ++i) run.times.push_back(from + static_cast<double>(i) / rate);
  const std::vector<int> sensors = list_sensors(noise);
  run.channels.reserve(sensors.size());
  for (const int channel : sensors) {
    run.channels.push_back(
        {channel, noise[static_cast<std::size_t>(channel)], std::vector<double>(count, 0.0)});
  }
  return run;
}

}  // namespace strut
