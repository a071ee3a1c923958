// Local polynomials against curves that they contain, and against noise and signals drawn here.
#include "base/math/local_polynomial.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include "base/math/spread.h"
#include "tests/support/campaign_files.h"
#include "tests/support/tolerance.h"

namespace strut {
namespace {

using test::tolerance;

std::vector<double> make_times(std::size_t count, double interval) {
  std::vector<double> times(count);
  for (std::size_t i = 0; i < count; ++i) times[i] = interval * static_cast<double>(i);
  return times;
}

std::vector<double> draw_noise(std::uint64_t seed, std::size_t count, double sigma) {
  std::vector<double> noise(count);
  for (std::size_t i = 0; i < count; ++i) noise[i] = sigma * test::calc_test_normal(seed, 0, i);
  return noise;
}

/// 1 + 2 s - 3 s^2 + ... - 7 s^6 + 8 s^7 up to s^degree, and its derivatives.
struct Powers {
  double value = 0.0, rate = 0.0, second_rate = 0.0;
  Powers(int degree, double s) {
    for (int k = 0; k <= degree; ++k) {
      const double a = (k % 2 == 0 && k > 0 ? -1.0 : 1.0) * (k + 1.0);
      value += a * std::pow(s, k);
      if (k > 0) rate += a * k * std::pow(s, k - 1);
      if (k > 1) second_rate += a * k * (k - 1) * std::pow(s, k - 2);
    }
  }
};

}  // namespace

TEST_CASE("A local polynomial gives polynomials and their derivatives exactly", "[property]") {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const int degree : {1, 3, 5, 7}) {
    std::vector<double> times, y;
    for (int i = 0; i < 200; ++i) {
      times.push_back(0.005 * i + 0.001 * (i % 3));
      y.push_back(i % 9 == 4 ? kNan : Powers(degree, times.back()).value);
    }
    const SmoothCurve curve = smooth(times, y, {0.08, degree});
    CHECK(std::isnan(curve.value.front()));
    for (std::size_t i = 20; i < 180; i += 7) {
      const Powers expected(degree, times[i]);
      CHECK(curve.value[i] == Approx(expected.value).margin(tolerance(1e-9)));
      CHECK(curve.rate[i] == Approx(expected.rate).margin(tolerance(1e-7)));
      CHECK(curve.second_rate[i] == Approx(expected.second_rate).margin(tolerance(1e-5)));
    }
  }
}

TEST_CASE("A one-sided local polynomial is defined everywhere on a clock with jitter",
          "[property]") {
  for (const int degree : {3, 7}) {
    const double half_width = 0.01 * degree;
    std::vector<double> times, y;
    for (std::uint64_t i = 0; i < 200; ++i) {
      times.push_back(0.01 * static_cast<double>(i) + 1e-6 * test::calc_test_normal(5, 0, i));
      y.push_back(Powers(degree, times.back() - 1.0).value);
    }
    const SmoothCurve inside = smooth(times, y, {half_width, degree});
    const SmoothCurve curve = smooth(times, y, {half_width, degree}, CurveEnds::kOneSided);
    CHECK(count_readings(inside.value) < 190);
    for (std::size_t i = 0; i < times.size(); ++i) {
      const Powers expected(degree, times[i] - 1.0);
      CHECK(curve.value[i] == Approx(expected.value).epsilon(tolerance(1e-8)));
      CHECK(curve.rate[i] == Approx(expected.rate).epsilon(tolerance(1e-6)));
    }
  }
}

TEST_CASE("Noise reaches a local cubic's second rate as stated", "[statistical]") {
  const std::vector<double> times = make_times(4000, 0.002), y = draw_noise(3, 4000, 1e-5);
  const double rms = calc_rms(smooth(times, y, {0.02}).second_rate);
  // 4000 samples in windows of 21: some 200 independent ones, 5 %.
  CHECK(rms == Approx(1e-5 * calc_second_rate_gain(0.02, 0.002)).epsilon(tolerance(0.2)));
}

/// Of a sine of 30 mm, as a damper's stand moves, read with 10 um of noise.
TEST_CASE("The chosen smoothing removes little of the signal and most of the noise",
          "[statistical]") {
  constexpr double kSigma = 1e-5, kAmplitude = 0.03, kInterval = 1e-3;
  const std::vector<double> times = make_times(4000, kInterval);
  for (const double frequency : {0.5, 4.0}) {
    const double rate = 2.0 * std::numbers::pi * frequency;
    std::vector<double> sine, readings = draw_noise(7, times.size(), kSigma);
    for (std::size_t i = 0; i < times.size(); ++i) {
      sine.push_back(kAmplitude * std::sin(rate * times[i]));
      readings[i] += sine.back();
    }
    const LocalPolynomial chosen = choose_smoothing(times, readings, kSigma);
    const SmoothCurve of_sine = smooth(times, sine, chosen), all = smooth(times, readings, chosen);
    std::vector<double> removed, noise_rate;
    for (std::size_t i = 0; i < times.size(); ++i) {
      if (std::isnan(all.value[i])) continue;
      removed.push_back(sine[i] - of_sine.value[i]);
      noise_rate.push_back(all.rate[i] - of_sine.rate[i]);
    }
    CHECK(calc_rms(removed) < 0.1 * kSigma);
    // A cubic that removes no more of 4 Hz leaves 0.7 mm/s of 10 um.
    CHECK(calc_rms(noise_rate) < 2.5e-4);
  }
  // Nothing can be smoothed of what changes from one reading to the next.
  std::vector<double> jumps = draw_noise(7, times.size(), kSigma);
  for (std::size_t i = 0; i < jumps.size(); ++i) jumps[i] += i % 4 < 2 ? 1.0 : 0.0;
  CHECK(choose_smoothing(times, jumps, kSigma).half_width == 0.0);
}

}  // namespace strut
