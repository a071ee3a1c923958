// Drift and mains of a sensor, estimated from periodograms of known spectra.
#include "diagnose/noise/sensor_color.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <vector>

#include "base/math/random.h"
#include "tests/support/tolerance.h"

namespace strut {
namespace {

constexpr std::size_t kSamples = 4000;
constexpr double kInterval = 0.002, kDuration = kSamples * kInterval;  // s

/// A periodogram of Gaussian noise with this color: exponentially distributed about its spectrum.
ResidualSpectrum draw_periodogram(const SensorColor& color, std::uint64_t seed) {
  ResidualSpectrum s;
  s.samples = kSamples;
  s.interval = kInterval;
  for (std::uint64_t k = 0; k <= kSamples / 2; ++k) {
    const double frequency = static_cast<double>(k) / kDuration;
    const double variance =
        1.0 + (k == 0 ? 0.0 : calc_color(color, frequency, kSamples, kInterval));
    s.power.push_back(-variance * std::log1p(-calc_uniform(seed, 0, k)));
    s.expected.push_back(1.0);
  }
  return s;
}

/// Corner frequency of drift with an rms of 0.3 sigma: the sum of f_c / f over both halves of the
/// spectrum is kSamples 0.3^2.
double calc_test_corner() {
  double sum = 0.0;
  for (std::size_t k = 1; k <= kSamples / 2; ++k) sum += 2.0 * kDuration / static_cast<double>(k);
  return 0.09 * kSamples / sum;
}

TEST_CASE("Drift of a sensor is measured by its corner frequency", "[statistical]") {
  SensorColor truth;
  truth.corner = calc_test_corner();
  double sum = 0.0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    sum += estimate_color(0, std::vector{draw_periodogram(truth, seed)}).corner / 20.0;
  }
  // The corner is resolved to 10 %, and one record has about 50 frequencies below it.
  CHECK(sum == Approx(truth.corner).epsilon(test::tolerance(0.2)));
}

/// rms of drift over sigma, of the candidates, by the largest posterior of periodogram values at
/// 0.5, 1, 1.5 and 2 Hz in 8 samples every 0.25 s.
double find_most_likely_drift(const std::vector<double>& power) {
  double best = 0.0, most = -1e9;
  for (const double rms : {0.0, 0.03, 0.06, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5}) {
    // Its mean square is the integral of f_c / f over both halves: 2 f_c dt (ln 4 + 0.5772).
    const double corner = rms * rms / (0.5 * (std::log(4.0) + 0.5772156649));
    double posterior = -0.5 * std::pow(rms / 0.25, 2.0);
    for (std::size_t k = 1; k <= 4; ++k) {
      const double expected = 1.0 + corner / (0.5 * static_cast<double>(k));
      posterior -= std::log(expected) + power[k] / expected;
    }
    if (posterior <= most) continue;
    most = posterior;
    best = corner;
  }
  return best;
}

TEST_CASE("Drift is as large as a prior of a quarter of sigma makes likely", "[unit]") {
  // The lowest frequency alone would ask for the largest drift, against which the prior speaks.
  for (const double lowest : {1.0, 2.0, 3.0, 4.0, 5.0, 8.0}) {
    const std::vector<double> power = {0.0, lowest, 1.0, 1.0, 1.0};
    const ResidualSpectrum s{8, 0.25, power, std::vector<double>(5, 1.0)};
    INFO(lowest);
    CHECK(estimate_color(0, std::vector{s}).corner ==
          Approx(find_most_likely_drift(power)).epsilon(test::tolerance(1e-9)));
  }
  CHECK(find_most_likely_drift({0.0, 4.0, 1.0, 1.0, 1.0}) <
        find_most_likely_drift({0.0, 8.0, 1.0, 1.0, 1.0}));
}

TEST_CASE("White noise has next to no color", "[statistical]") {
  int lines = 0;
  double corner = 0.0;
  for (std::uint64_t seed = 100; seed < 150; ++seed) {
    const SensorColor color = estimate_color(3, std::vector{draw_periodogram({}, seed)});
    CHECK(color.channel == 3);
    lines += static_cast<int>(color.lines.size());
    corner += color.corner / 50.0;
  }
  CHECK(lines == 0);
  CHECK(corner < 0.05 * calc_test_corner());
}

TEST_CASE("A line of the mains is noise as long as it is smaller than the sensor's", "[unit]") {
  SensorColor truth;
  truth.lines.push_back({50.06, 0.3});
  const SensorColor found = estimate_color(0, std::vector{draw_periodogram(truth, 7)});
  REQUIRE(found.lines.size() == 1);
  CHECK(found.lines[0].frequency == Approx(50.06).margin(2.0 / kDuration));
  CHECK(found.lines[0].rms == Approx(0.3).epsilon(test::tolerance(1.0)));
  truth.lines[0].rms = 10.0;
  CHECK(estimate_color(0, std::vector{draw_periodogram(truth, 7)}).lines.empty());
  // Elsewhere it is no line of the mains.
  truth.lines = {{43.0, 0.3}};
  CHECK(estimate_color(0, std::vector{draw_periodogram(truth, 7)}).lines.empty());
}

TEST_CASE("The color of a tone is the mean power of its transform", "[unit]") {
  // A tone halfway between two frequencies, by the transform written out.
  const double rms = 0.5, frequency = 200.5 / kDuration, turn = 2.0 * std::acos(-1.0);
  SensorColor color;
  color.lines.push_back({frequency, rms});
  for (const int away : {0, 3, 10}) {
    const int k = 201 + away;
    double mean = 0.0;  // over the tone's phase
    for (const double phase : {0.0, 0.25 * turn}) {
      double re = 0.0, im = 0.0;
      for (std::size_t i = 0; i < kSamples; ++i) {
        const double t = static_cast<double>(i) * kInterval;
        const double y = std::sqrt(2.0) * rms * std::cos(turn * frequency * t + phase);
        re += y * std::cos(turn * k * static_cast<double>(i) / kSamples);
        im -= y * std::sin(turn * k * static_cast<double>(i) / kSamples);
      }
      mean += 0.5 * (re * re + im * im) / kSamples;
    }
    CHECK(calc_color(color, k / kDuration, kSamples, kInterval) ==
          Approx(mean).epsilon(test::tolerance(0.02)));
  }
}

}  // namespace
}  // namespace strut
