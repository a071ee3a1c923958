// Effects of sensors: from a channel's samples to the readings of an imperfect sensor.
//
//   reading(t) = (1 + e) z(t - tau) + b,   T dz/dt + z = y
//
// y is the channel, a cubic spline between its samples and constant before the first and after the
// last; the filter starts settled. Readings are made from a finished run, so a sensor changes
// neither the simulation nor channels derived from its own.
#pragma once

#include <string>
#include <vector>

#include "model/channel/channel_info.h"
#include "model/effects/setting.h"

namespace strut {

/// The sensor of one channel; by default ideal.
struct ChannelSensor {
  double gain = 0.0;   // e, sensor_gain
  double bias = 0.0;   // b, sensor_bias, unit of the channel
  double delay = 0.0;  // tau, sensor_delay and clock_offset, s; < 0: early
  double time = 0.0;   // T, sensor_lowpass, s

  /// Whether a reading depends on the channel at other instants.
  bool has_memory() const { return delay != 0.0 || time != 0.0; }
  bool is_on() const { return has_memory() || gain != 0.0 || bias != 0.0; }
  double amplify(double value) const { return (1.0 + gain) * value + bias; }
};

/// The settings that act on channels.
EffectSettings list_sensor_settings(const EffectSettings& settings);

/// The sensor of a channel by the effects of a model of any kind; clock_offset delays those that
/// are not given.
ChannelSensor find_sensor(const EffectSettings& settings, const ChannelInfo& channel);

/// Readings at `times` [s] of a channel sampled every `interval` [s] from t = 0; NaN throughout
/// where a sample is not finite.
std::vector<double> read_sensor(const ChannelSensor& sensor, double interval,
                                std::vector<double> samples, const std::vector<double>& times);

/// Readings at the sample times; the samples, bit for bit, where no effect acts on `channel`.
std::vector<double> read_sensor(const EffectSettings& settings, const ChannelInfo& channel,
                                double interval, std::vector<double> samples);

}  // namespace strut
