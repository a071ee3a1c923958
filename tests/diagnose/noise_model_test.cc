// Estimates of noise from a record alone.
#include "diagnose/campaign/noise_model.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/support/campaign_files.h"
#include "tests/support/test_car.h"

namespace strut {
namespace {

/// A 5 Hz motion of 10 mm sampled at 500 Hz, with noise and, in a fifth of it, a blow.
std::vector<double> make_readings(double sigma, bool blow, std::uint64_t seed = 5) {
  std::vector<double> values;
  for (std::uint64_t i = 0; i < 10000; ++i) {
    const double t = static_cast<double>(i) / 500.0;
    double y = 0.01 * std::sin(31.4 * t) + sigma * test::calc_test_normal(seed, 0, i);
    if (blow && i > 4000 && i < 6000) y += 0.02 * std::sin(900.0 * t);
    values.push_back(y);
  }
  return values;
}

TEST_CASE("Known noise on a moving channel is measured to a few per cent", "[statistical]") {
  // 10000 samples: 156 blocks, 1 sigma of the estimate 1.4 %.
  for (const double sigma : {1e-3, 1e-4, 1e-5}) {
    const NoiseEstimate estimate = estimate_noise(make_readings(sigma, false));
    CHECK(estimate.sigma == Approx(sigma).epsilon(test::tolerance(0.05)));
    CHECK(estimate.source == NoiseSource::kEstimated);
    CHECK(estimate.uncertainty == Approx(0.0143).epsilon(0.02));
  }
}

TEST_CASE("The stated uncertainty of an estimated noise is its standard deviation",
          "[statistical]") {
  double squares = 0.0, sum = 0.0;
  constexpr int kDraws = 200;
  for (int i = 0; i < kDraws; ++i) {
    const double error =
        estimate_noise(make_readings(1e-4, false, 100 + static_cast<std::uint64_t>(i))).sigma /
            1e-4 -
        1.0;
    sum += error;
    squares += error * error;
  }
  // 200 draws know a spread to 5 %, a mean of 1.4 % to 0.1 %; both within 4 sigmas.
  CHECK(std::sqrt(squares / kDraws) == Approx(0.0143).epsilon(test::tolerance(0.25)));
  CHECK(std::abs(sum / kDraws) < test::tolerance(0.005));
}

/// A sum of tones up to a third of a sampling rate of 600 Hz, as an oscillator is driven by, with
/// noise.
std::vector<double> make_fast_motion(double sigma) {
  std::vector<double> values;
  for (std::uint64_t i = 0; i < 10000; ++i) {
    const double t = static_cast<double>(i) / 600.0;
    double y = sigma * test::calc_test_normal(7, 0, i);
    for (double f = 0.7; f < 200.0; f += 1.3) y += 0.01 * std::sin(6.283 * f * t + f * f);
    values.push_back(y);
  }
  return values;
}

TEST_CASE("Motion up to a third of the sampling rate does not count as noise", "[statistical]") {
  for (const double sigma : {1e-5, 1e-4, 1e-3}) {
    INFO(sigma);
    const NoiseEstimate estimate = estimate_noise(make_fast_motion(sigma));
    // 156 blocks of 3.6 degrees know a band's power to 7 %, sigma to half of it.
    CHECK(estimate.sigma == Approx(sigma).epsilon(test::tolerance(0.15)));
    CHECK(estimate.uncertainty == Approx(0.037).epsilon(0.05));
  }
}

TEST_CASE("A blow in a fifth of a record does not count as noise", "[unit]") {
  CHECK(estimate_noise(make_readings(1e-4, true)).sigma ==
        Approx(1e-4).epsilon(test::tolerance(0.25)));  // the median moves up by a tenth of blocks
}

TEST_CASE("A coarse encoder's noise is at least that of rounding", "[unit]") {
  std::vector<double> values;
  for (int i = 0; i < 5000; ++i) {
    const double t = i / 500.0;
    values.push_back(std::round(0.004 * std::sin(0.5 * t) / 2.5e-4) * 2.5e-4);
  }
  const NoiseEstimate estimate = estimate_noise(values);
  CHECK(estimate.quantum == Approx(2.5e-4));
  CHECK(estimate.sigma == Approx(2.5e-4 / std::sqrt(12.0)));
  CHECK(estimate.source == NoiseSource::kQuantized);
}

TEST_CASE("Missing samples do not disturb the noise", "[unit]") {
  std::vector<double> values = make_readings(1e-4, false);
  for (std::size_t i = 0; i < values.size(); i += 23) {
    values[i] = std::numeric_limits<double>::quiet_NaN();
  }
  CHECK(estimate_noise(values).sigma == Approx(1e-4).epsilon(test::tolerance(0.06)));
}

}  // namespace
}  // namespace strut
