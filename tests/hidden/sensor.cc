#include "tests/hidden/sensor.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>

#include "tests/hidden/random_stream.h"

namespace strut::hidden {
namespace {

constexpr double kTwoPi = 6.28318530717958647692;
constexpr double kMains = 50.0;  // Hz

/// Drift as a sum of first-order processes of equal variance whose correlation times are octaves
/// apart: nearly 1/f between the ends.
constexpr double kShortest = 4e-3, kLongest = 2.1;  // s

std::vector<double> list_correlation_times() {
  std::vector<double> times;
  for (double t = kShortest; t < kLongest; t *= 2.0) times.push_back(t);
  return times;
}

/// Drift of unit variance at `count` stamps `interval` [s] apart.
std::vector<double> draw_drift(RandomStream& draws, std::size_t count, double interval) {
  std::vector<double> sum(count, 0.0);
  const std::vector<double> times = list_correlation_times();
  const double size = 1.0 / std::sqrt(static_cast<double>(times.size()));
  for (const double time : times) {
    const double keep = std::exp(-interval / time), step = std::sqrt(1.0 - keep * keep);
    double x = draws.draw_normal();
    for (double& v : sum) {
      v += size * x;
      x = keep * x + step * draws.draw_normal();
    }
  }
  return sum;
}

/// Drift and hum at the stamps, in SI; they have streams of their own, so that the other noise does
/// not depend on them.
std::vector<double> draw_colored_noise(const Sensor& sensor, const std::vector<double>& stamps,
                                       std::uint64_t seed, const std::string& purpose) {
  std::vector<double> noise(stamps.size(), 0.0);
  if (stamps.size() < 2) return noise;
  if (sensor.drift > 0.0) {
    RandomStream draws(seed, "drift " + purpose + " " + sensor.channel);
    noise = draw_drift(draws, stamps.size(), stamps[1] - stamps[0]);
    for (double& v : noise) v *= sensor.drift * sensor.noise;
  }
  RandomStream draws(seed, "hum " + purpose + " " + sensor.channel);
  const double phase = draws.draw_uniform(0.0, kTwoPi);
  for (std::size_t i = 0; i < noise.size(); ++i) {
    noise[i] +=
        std::sqrt(2.0) * sensor.hum * sensor.noise * std::sin(kTwoPi * kMains * stamps[i] + phase);
  }
  return noise;
}

}  // namespace

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

double calc_drift_spectrum(const Sensor& sensor, double frequency, double rate) {
  double sum = 0.0;
  const std::vector<double> times = list_correlation_times();
  const std::complex<double> turn = std::polar(1.0, -kTwoPi * frequency / rate);
  for (const double time : times) {
    const double keep = std::exp(-1.0 / (rate * time));
    sum += (1.0 - keep * keep) / std::norm(1.0 - keep * turn);
  }
  return sensor.drift * sensor.drift * sum / static_cast<double>(times.size());
}

std::vector<double> read_sensor(const Sensor& sensor, const Signal& signal, const Clock& clock,
                                const std::vector<double>& stamps, double bias, std::uint64_t seed,
                                const std::string& purpose) {
  // Channels of one file are sampled together: the jitter's stream does not name the channel.
  RandomStream jitter(seed, "jitter " + purpose);
  RandomStream noise(seed, "noise " + purpose + " " + sensor.channel);
  const std::vector<double> colored = draw_colored_noise(sensor, stamps, seed, purpose);
  std::vector<double> readings;
  readings.reserve(stamps.size());
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    const double at =
        (1.0 + clock.drift) * stamps[i] + clock.offset + clock.jitter * jitter.draw_normal();
    double v = signal.evaluate(at) + bias + sensor.noise * noise.draw_normal() + colored[i];
    v = std::clamp(v, -sensor.range, sensor.range);
    if (sensor.quantum > 0.0) v = sensor.quantum * std::nearbyint(v / sensor.quantum);
    readings.push_back(v / sensor.unit_scale);
  }
  return readings;
}

}  // namespace strut::hidden
