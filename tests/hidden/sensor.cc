#include "tests/hidden/sensor.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "tests/hidden/random_stream.h"

namespace strut::hidden {

double Signal::evaluate(double t) const {
  const double place = (t - begin) / spacing;
  const auto last = static_cast<double>(value.size() - 1);
  const double inside = std::clamp(place, 0.0, last);
  const auto i = std::min(static_cast<std::size_t>(inside), value.size() - 2);
  const double u = inside - static_cast<double>(i);
  const double b = value[i], c = value[i + 1];
  const double a = i > 0 ? value[i - 1] : 2.0 * b - c;
  const double d = i + 2 < value.size() ? value[i + 2] : 2.0 * c - b;
  // Catmull and Rom's cubic.
  return b +
         0.5 * u * (c - a + u * (2.0 * a - 5.0 * b + 4.0 * c - d + u * (3.0 * (b - c) + d - a)));
}

Signal distort(const Signal& signal, const FaultSetting& fault) {
  Signal out = signal;
  const double m = fault.magnitude;
  switch (fault.fault) {
    case Fault::kSensorGain:
      for (double& v : out.value) v *= 1.0 + m;
      break;
    case Fault::kSensorDelay:
      for (std::size_t i = 0; i < out.value.size(); ++i) {
        out.value[i] = signal.evaluate(signal.begin + signal.spacing * static_cast<double>(i) - m);
      }
      break;
    case Fault::kSensorLowpass: {
      // Exact for a signal that is linear between the samples.
      const double h = signal.spacing, keep = std::exp(-h / m);
      for (std::size_t i = 1; i < out.value.size(); ++i) {
        const double slope = (signal.value[i] - signal.value[i - 1]) / h;
        const double lag_before = out.value[i - 1] - (signal.value[i - 1] - m * slope);
        out.value[i] = signal.value[i] - m * slope + keep * lag_before;
      }
      break;
    }
    case Fault::kSaturation:
      for (double& v : out.value)
        v = std::clamp(v, -(1.0 - m) * fault.peak, (1.0 - m) * fault.peak);
      break;
    default:
      break;
  }
  return out;
}

std::vector<double> read_sensor(const Sensor& sensor, const Signal& signal, const Clock& clock,
                                const std::vector<double>& stamps, double bias, std::uint64_t seed,
                                const std::string& purpose) {
  // Channels of one file are sampled together: the jitter's stream does not name the channel.
  RandomStream jitter(seed, "jitter " + purpose);
  RandomStream noise(seed, "noise " + purpose + " " + sensor.channel);
  std::vector<double> readings;
  readings.reserve(stamps.size());
  for (const double stamp : stamps) {
    const double at =
        (1.0 + clock.drift) * stamp + clock.offset + clock.jitter * jitter.draw_normal();
    double v = signal.evaluate(at) + bias + sensor.noise * noise.draw_normal();
    v = std::clamp(v, -sensor.range, sensor.range);
    if (sensor.quantum > 0.0) v = sensor.quantum * std::nearbyint(v / sensor.quantum);
    readings.push_back(v / sensor.unit_scale);
  }
  return readings;
}

}  // namespace strut::hidden
