#include "model/sensor/sensors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "base/math/exponential.h"
#include "model/effects/names.h"
#include "model/scenario/input_signal.h"

namespace strut {
namespace {

struct SensorEffect {
  const char* name;
  double ChannelSensor::*value;
};
constexpr std::array<SensorEffect, 5> kSensorEffects = {
    {{EffectName::kSensorGain, &ChannelSensor::gain},
     {EffectName::kSensorBias, &ChannelSensor::bias},
     {EffectName::kSensorDelay, &ChannelSensor::delay},
     {EffectName::kClockOffset, &ChannelSensor::delay},
     {EffectName::kSensorLowpass, &ChannelSensor::time}}};

const SensorEffect* find_sensor_effect(const std::string& name) {
  for (const SensorEffect& effect : kSensorEffects) {
    if (effect.name == name) return &effect;
  }
  return nullptr;
}

std::vector<double> list_sample_times(double interval, std::size_t count) {
  std::vector<double> times(count);
  for (std::size_t i = 0; i < count; ++i) times[i] = interval * static_cast<double>(i);
  return times;
}

/// Replaces the samples of y by those of z, T dz/dt + z = y; exact for y a cubic between samples.
void filter(const std::vector<double>& times, double interval, double time_constant,
            std::vector<double>& values) {
  const InputSignal y = make_signal("sensor", times, values, Interpolation::kSpline);
  const double h = interval;
  const PhiFunctions<double> phi = calc_phi(-h / time_constant);
  double z = values.front();
  for (std::size_t i = 1; i < values.size(); ++i) {
    const SignalCell& c = y.cells[i - 1];
    const double pull =
        c.c0 * phi.phi1 +
        h * (c.c1 * phi.phi2 + h * (2.0 * c.c2 * phi.phi3 + 6.0 * c.c3 * h * phi.phi4));
    z = phi.exponential * z + h / time_constant * pull;
    values[i] = z;
  }
}

}  // namespace

EffectSettings list_sensor_settings(const EffectSettings& settings) {
  EffectSettings found;
  std::copy_if(settings.begin(), settings.end(), std::back_inserter(found),
               [](const EffectSetting& s) { return find_sensor_effect(s.effect) != nullptr; });
  return found;
}

ChannelSensor find_sensor(const EffectSettings& settings, const ChannelInfo& channel) {
  ChannelSensor sensor;
  for (const EffectSetting& setting : settings) {
    const bool is_clock = setting.effect == EffectName::kClockOffset;
    if (is_clock ? channel.is_given : setting.place != channel.name) continue;
    const SensorEffect* effect = find_sensor_effect(setting.effect);
    if (effect != nullptr) sensor.*(effect->value) += setting.values.at(0);
  }
  return sensor;
}

std::vector<double> read_sensor(const ChannelSensor& sensor, double interval,
                                std::vector<double> samples, const std::vector<double>& times) {
  const bool finite =
      std::all_of(samples.begin(), samples.end(), [](double y) { return std::isfinite(y); });
  if (!finite || samples.empty()) {
    return std::vector<double>(times.size(), std::numeric_limits<double>::quiet_NaN());
  }
  std::vector<double> readings(times.size(), samples.front());
  if (samples.size() > 1) {
    const std::vector<double> sampled = list_sample_times(interval, samples.size());
    if (sensor.time > 0.0) filter(sampled, interval, sensor.time, samples);
    const InputSignal z = make_signal("sensor", sampled, samples, Interpolation::kSpline);
    std::transform(times.begin(), times.end(), readings.begin(),
                   [&](double t) { return calc_signal(z, t - sensor.delay).value; });
  }
  for (double& y : readings) y = sensor.amplify(y);
  return readings;
}

std::vector<double> read_sensor(const EffectSettings& settings, const ChannelInfo& channel,
                                double interval, std::vector<double> samples) {
  const ChannelSensor sensor = find_sensor(settings, channel);
  if (!sensor.is_on()) return samples;
  if (sensor.has_memory()) {
    const std::vector<double> times = list_sample_times(interval, samples.size());
    return read_sensor(sensor, interval, std::move(samples), times);
  }
  for (double& y : samples) y = sensor.amplify(y);
  return samples;
}

}  // namespace strut
