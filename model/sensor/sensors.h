// Effects of sensors: from a channel's samples to what a sensor with its faults would read.
//
//   reading(t) = (1 + e) z(t - tau) + b,   T dz/dt + z = y
//
// y is the channel, a cubic spline between its samples; before the first and after the last it
// stands still, and the filter starts settled. Readings are made from a finished run, so no sensor
// changes a simulation, nor a channel that derives from another.
#pragma once

#include <string>
#include <vector>

#include "model/effects/setting.h"

namespace strut {

/// The faults of the sensor of one channel; neutral where none is on.
struct ChannelSensor {
  double gain = 0.0;   // e, sensor_gain
  double bias = 0.0;   // b, sensor_bias, unit of the channel
  double delay = 0.0;  // tau, sensor_delay, s; < 0: early
  double time = 0.0;   // T, sensor_lowpass, s

  /// Whether a reading takes more than the channel's value at that instant.
  bool has_memory() const { return delay != 0.0 || time != 0.0; }
  bool is_on() const { return has_memory() || gain != 0.0 || bias != 0.0; }
  double amplify(double value) const { return (1.0 + gain) * value + bias; }
};

/// The settings of `settings` that are of sensors' channels.
EffectSettings list_sensor_settings(const EffectSettings& settings);

/// `settings`: of any kind of model; a search through them, nothing more.
ChannelSensor find_sensor(const EffectSettings& settings, const std::string& channel);

/// Readings at `times` [s] of a channel sampled every `interval` [s] from t = 0; NaN throughout
/// where a sample is not finite.
std::vector<double> read_sensor(const ChannelSensor& sensor, double interval,
                                std::vector<double> samples, const std::vector<double>& times);

/// The same at the samples themselves; unchanged, bit for bit, where no effect is on at `channel`.
std::vector<double> read_sensor(const EffectSettings& settings, const std::string& channel,
                                double interval, std::vector<double> samples);

}  // namespace strut
