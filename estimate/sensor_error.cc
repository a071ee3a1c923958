#include "estimate/sensor_error.h"

#include <cmath>

namespace strut {
namespace {

std::vector<double> calc_rates(std::span<const double> times, std::span<const double> values) {
  std::vector<double> rates(values.size(), 0.0);
  std::vector<std::size_t> there;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i])) there.push_back(i);
  }
  const auto slope = [&](std::size_t k) {  // from sample k to the next one
    return (values[there[k + 1]] - values[there[k]]) / (times[there[k + 1]] - times[there[k]]);
  };
  for (std::size_t k = 0; there.size() > 1 && k < there.size(); ++k) {
    if (k == 0 || k + 1 == there.size()) {
      rates[there[k]] = slope(k == 0 ? 0 : k - 1);
      continue;
    }
    const double before = times[there[k]] - times[there[k - 1]];
    const double after = times[there[k + 1]] - times[there[k]];
    rates[there[k]] = (after * slope(k - 1) + before * slope(k)) / (before + after);
  }
  return rates;
}

}  // namespace

SensorError collect_sensor_error(const std::vector<Unknown>& unknowns,
                                 const std::vector<double>& values, std::size_t run, int channel) {
  SensorError error;
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    const Unknown& u = unknowns[i];
    if (u.channel != channel || !belongs(u, run)) continue;
    if (u.kind == UnknownKind::kBias) error.bias += values[i];
    if (u.kind == UnknownKind::kSensorGain) error.gain += values[i];
    if (u.kind == UnknownKind::kSensorSkew) error.skew += values[i];
  }
  return error;
}

void add_sensor_error(const SensorError& error, std::span<const double> times,
                      std::span<double> values) {
  if (error.is_zero()) return;
  std::vector<double> rates(values.size(), 0.0);
  if (error.skew != 0.0) rates = calc_rates(times, values);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] += error.gain * values[i] - error.skew * rates[i] + error.bias;
  }
}

std::vector<double> calc_error_slopes(UnknownKind kind, std::span<const double> times,
                                      std::span<const double> values) {
  if (kind == UnknownKind::kBias) return std::vector<double>(values.size(), 1.0);
  if (kind == UnknownKind::kSensorGain) return {values.begin(), values.end()};
  std::vector<double> slopes = calc_rates(times, values);
  for (double& slope : slopes) slope = -slope;
  return slopes;
}

}  // namespace strut
