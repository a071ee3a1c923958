#include "estimate/measured_run.h"

#include <fmt/format.h>

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
    const std::string after =
        i == 0 ? "" : fmt::format(" after {} s", format_number(run.times[i - 1]));
    throw InputError(fmt::format("{}: time = {} s in sample {}{}: must be finite and ascend",
                                 run.name, format_number(run.times[i]), i + 1, after));
  }
}

void check_channel(const MeasuredRun& run, const MeasuredChannel& c) {
  const std::string& name = get_channel_name(run, c);
  const auto same = [&](const MeasuredChannel& other) { return other.channel == c.channel; };
  if (std::count_if(run.channels.begin(), run.channels.end(), same) > 1) {
    throw InputError(
        fmt::format("{}: channel '{}' is given twice; must be given once", run.name, name));
  }
  if (!(c.sigma > 0.0) || !std::isfinite(c.sigma)) {
    throw InputError(fmt::format("{}: noise of {} = {}: must be > 0 and finite", run.name, name,
                                 format_number(c.sigma)));
  }
  if (c.values.size() != run.times.size()) {
    throw InputError(fmt::format("{}: {} has {} readings for {} times; must have one for each",
                                 run.name, name, c.values.size(), run.times.size()));
  }
  const auto bad = std::find_if_not(c.values.begin(), c.values.end(), [&](double v) {
    return std::isfinite(v) || (run.may_miss && std::isnan(v));
  });
  if (bad != c.values.end()) {
    throw InputError(fmt::format("{}: {} in sample {}: must be a finite number", run.name, name,
                                 bad - c.values.begin() + 1));
  }
}

}  // namespace

std::string ColumnReading::guess_true_unit(const std::string& si, double factor) const {
  return scale == 1.0 ? guess_unit(si, factor / unit) : "";
}

ColumnReading make_column_reading(const ColumnConversion& conversion, double delay) {
  return {conversion.unit.factor, std::abs(conversion.factor), delay};
}

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
  if (run.times.empty()) throw InputError(run.name + ": no samples");
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
