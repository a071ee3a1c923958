#include "model/effects/sensors.h"

#include <cmath>
#include <utility>

#include "model/effects/strut_numbers.h"
#include "model/integrate/exponential.h"
#include "model/scenario/input_signal.h"

namespace strut {
namespace {

std::vector<double> delay(const std::string& channel, const std::vector<double>& times,
                          const std::vector<double>& values, double by) {
  const InputSignal signal = make_signal(channel, times, values, Interpolation::kSpline);
  std::vector<double> late;
  late.reserve(values.size());
  for (const double t : times) late.push_back(calc_signal(signal, t - by).value);
  return late;
}

/// T dz/dt + z = y, exact for a y that is linear between samples.
void filter(const std::vector<double>& times, double time_constant, std::vector<double>& values) {
  double z = values.front(), y0 = values.front();
  for (std::size_t i = 1; i < values.size(); ++i) {
    const double h = times[i] - times[i - 1], y1 = values[i];
    const PhiFunctions<double> phi = calc_phi(-h / time_constant);
    z = phi.exponential * z + h / time_constant * (phi.phi1 * y0 + phi.phi2 * (y1 - y0));
    y0 = y1;
    values[i] = z;
  }
}

}  // namespace

std::vector<double> read_sensor(const EffectSettings& settings, ModelKind kind,
                                const std::string& channel, const std::vector<double>& times,
                                std::vector<double> values) {
  const EffectValues of{settings, kind};
  const double gain = of.get("sensor_gain", "gain", channel);
  const double bias = of.get("sensor_bias", "bias", channel);
  const double late = of.get("sensor_delay", "delay", channel);
  const double slow = of.get("sensor_lowpass", "time", channel);
  if (slow != 0.0 && !values.empty()) filter(times, slow, values);
  if (late != 0.0) values = delay(channel, times, values, late);
  if (gain == 0.0 && bias == 0.0) return values;
  for (double& value : values) value = (1.0 + gain) * value + bias;
  return values;
}

}  // namespace strut
