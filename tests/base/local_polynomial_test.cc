// Local polynomials against curves that they contain, and against noise and signals drawn here.
#include "base/math/local_polynomial.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
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
    const SmoothCurve curve = calc_local_polynomial(times, y, {0.08, degree});
    CHECK(std::isnan(curve.value.front()));
    for (std::size_t i = 20; i < 180; i += 7) {
      const Powers expected(degree, times[i]);
      CHECK(std::abs(curve.value[i] - expected.value) < tolerance(1e-11));
      CHECK(std::abs(curve.rate[i] - expected.rate) < tolerance(1e-9));
      CHECK(std::abs(curve.second_rate[i] - expected.second_rate) < tolerance(1e-6));
    }
  }
}

/// Windows on a clock with jitter hold a reading less than they need here and there, and none at
/// all in a gap.
TEST_CASE("A one-sided local polynomial is defined everywhere", "[property]") {
  for (const int degree : {3, 5, 7}) {
    const int m = (degree + 3) / 2;
    for (const int gap : {0, 30}) {
      std::vector<double> times, y;
      for (std::uint64_t i = 0; i < 200; ++i) {
        if (std::abs(static_cast<int>(i) - 100) < gap / 2) continue;
        times.push_back(0.01 * static_cast<double>(i) + 1e-6 * test::calc_test_normal(5, 0, i));
        y.push_back(Powers(degree, times.back() - 1.0).value);
      }
      const double half_width = 0.01 * m;
      const SmoothCurve inside = calc_local_polynomial(times, y, {half_width, degree});
      const SmoothCurve curve =
          calc_local_polynomial(times, y, {half_width, degree}, CurveEnds::kOneSided);
      CHECK(count_readings(inside.value) < times.size() - static_cast<std::size_t>(2 * m));
      for (std::size_t i = 0; i < times.size(); ++i) {
        const Powers expected(degree, times[i] - 1.0);
        CHECK(std::abs(curve.value[i] - expected.value) < tolerance(1e-8));
        CHECK(std::abs(curve.rate[i] - expected.rate) < tolerance(1e-6));
      }
    }
  }
}

TEST_CASE("Noise reaches a local cubic's second rate as stated", "[statistical]") {
  const std::vector<double> times = make_times(4000, 0.002), y = draw_noise(3, 4000, 1e-5);
  const double rms = calc_rms(calc_local_polynomial(times, y, {0.02, 3}).second_rate);
  // 4000 samples in windows of 21: some 200 independent ones, 5 %.
  CHECK(rms == Approx(1e-5 * calc_second_rate_gain(0.02, 0.002)).epsilon(tolerance(0.2)));
}

/// A sine of 30 mm, as a damper's stand moves, is read with 10 um of noise. At 1.6, 4 and 7 Hz the
/// widest windows of one degree remove one sigma of it, which is not yet clear beside the noise.
TEST_CASE("The chosen smoothing removes little of the signal and most of the noise",
          "[statistical]") {
  constexpr double kSigma = 1e-5, kAmplitude = 0.03, kInterval = 1e-3;
  const std::vector<double> times = make_times(4000, kInterval);
  for (const double frequency : {0.5, 1.6, 4.0, 7.0}) {
    const double rate = 2.0 * std::numbers::pi * frequency;
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
      std::vector<double> sine, readings = draw_noise(seed, times.size(), kSigma);
      for (std::size_t i = 0; i < times.size(); ++i) {
        sine.push_back(kAmplitude * std::sin(rate * times[i]));
        readings[i] += sine.back();
      }
      const LocalPolynomial chosen = choose_smoothing(times, readings, kSigma);
      const SmoothCurve of_sine = calc_local_polynomial(times, sine, chosen);
      const SmoothCurve of_readings = calc_local_polynomial(times, readings, chosen);
      std::vector<double> removed, noise_rate;
      for (std::size_t i = 0; i < times.size(); ++i) {
        if (std::isnan(of_readings.value[i])) continue;
        removed.push_back(sine[i] - of_sine.value[i]);
        noise_rate.push_back(of_readings.rate[i] - of_sine.rate[i]);
      }
      CHECK(calc_rms(removed) < 0.12 * kSigma);
      // A cubic that removes no more of 4 Hz leaves 0.7 mm/s of 10 um.
      if (frequency <= 4.0) CHECK(calc_rms(noise_rate) < 2.5e-4);
    }
  }
}

TEST_CASE("What cannot be smoothed is not", "[unit]") {
  const std::vector<double> times = make_times(4000, 1e-3);
  std::vector<double> jumps = draw_noise(7, times.size(), 1e-5);
  for (std::size_t i = 0; i < jumps.size(); ++i) jumps[i] += i % 4 < 2 ? 1.0 : 0.0;
  CHECK(choose_smoothing(times, jumps, 1e-5).half_width == 0.0);
  CHECK(choose_smoothing({}, {}, 1e-5).half_width == 0.0);
  const std::vector<double> one = {0.0}, two = {0.0, 1.0}, same = {0.5, 0.5, 0.5, 0.5};
  CHECK(choose_smoothing(one, one, 1e-5).half_width == 0.0);
  CHECK(choose_smoothing(two, two, 1e-5).half_width == 0.0);
  CHECK(choose_smoothing(same, same, 1e-5).half_width == 0.0);
  CHECK(choose_smoothing(times, jumps, 0.0).half_width == 0.0);
  // A half width far beyond the record is half of the record.
  std::vector<double> line;
  line.reserve(times.size());
  for (const double t : times) line.push_back(2.0 + 3.0 * t);
  const SmoothCurve curve = calc_local_polynomial(times, line, {1e6, 3}, CurveEnds::kOneSided);
  CHECK(std::abs(curve.value.front() - 2.0) < tolerance(1e-11));
  CHECK(std::abs(curve.rate.back() - 3.0) < tolerance(1e-9));
}

}  // namespace strut
