// Residuals by time, band and state, against signals of known content.
#include "diagnose/baseline/residuals.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "base/math/spread.h"
#include "diagnose/baseline/body_balance.h"
#include "diagnose/compare/compare.h"
#include "tests/support/campaign_files.h"
#include "tests/support/test_car.h"

namespace strut {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::vector<double> make_times(std::size_t count, double interval) {
  std::vector<double> times;
  for (std::size_t i = 0; i < count; ++i) times.push_back(static_cast<double>(i) * interval);
  return times;
}

TEST_CASE("Sines fall into their bands with their own rms", "[unit]") {
  const std::vector<double> times = make_times(4000, 0.005);
  std::vector<double> y;
  y.reserve(times.size());
  for (const double t : times) {
    y.push_back(std::sin(2 * kPi * 2.0 * t) + 0.5 * std::sin(2 * kPi * 5.0 * t) +
                0.1 * std::sin(2 * kPi * 30.0 * t) + 7.0);
  }
  const auto bands = calc_band_residuals(times, y, y, 0.02);
  const double expected[] = {0.0, 1.0, 0.5, 0.0, 0.1};
  double squares = 0.0, noise = 0.0;
  for (std::size_t b = 0; b < bands.size(); ++b) {
    // 20 s hold whole periods of all three: no leakage.
    CHECK(bands[b].residual_rms ==
          Approx(expected[b] / std::sqrt(2.0)).margin(test::tolerance(1e-9)));
    squares += bands[b].residual_rms * bands[b].residual_rms;
    noise += bands[b].noise_rms * bands[b].noise_rms;
  }
  CHECK(std::sqrt(squares) == Approx(calc_spread(y)).epsilon(test::tolerance(1e-12)));
  CHECK(std::sqrt(noise) == Approx(0.02).epsilon(test::tolerance(1e-12)));
}

TEST_CASE("Bands are exact for numbers of samples with a large prime factor", "[unit]") {
  // 4001 is prime; 40 periods fit into as many samples.
  constexpr std::size_t kCount = 4001;
  const std::vector<double> times = make_times(kCount, 0.005);
  std::vector<double> y;
  y.reserve(kCount);
  for (const double t : times) y.push_back(std::sin(2 * kPi * 40.0 * t / (0.005 * kCount)));
  const auto bands = calc_band_residuals(times, y, y, 0.0);
  const double expected[] = {0.0, 1.0, 0.0, 0.0, 0.0};
  for (std::size_t b = 0; b < bands.size(); ++b) {
    CHECK(bands[b].residual_rms ==
          Approx(expected[b] / std::sqrt(2.0)).margin(test::tolerance(1e-9)));
  }
}

TEST_CASE("Missing samples leave the bands of a slow signal as they are", "[unit]") {
  const std::vector<double> times = make_times(4000, 0.005);
  std::vector<double> y;
  for (std::size_t i = 0; i < times.size(); ++i) {
    y.push_back(i % 6 == 3 ? kNan : std::sin(2 * kPi * 2.0 * times[i]));
  }
  const auto bands = calc_band_residuals(times, y, y, 0.0);
  // Linear interpolation over 10 ms of 2 Hz.
  CHECK(bands[1].residual_rms == Approx(1.0 / std::sqrt(2.0)).epsilon(test::tolerance(2e-3)));
  CHECK(bands[4].residual_rms < test::tolerance(2e-3));
}

TEST_CASE("Windows divide up the mean square of a residual", "[unit]") {
  const std::vector<double> times = make_times(1000, 0.01);
  std::vector<double> y(1000, 1.0);
  for (std::size_t i = 500; i < 1000; ++i) y[i] = -3.0;
  y[10] = kNan;
  const auto windows =
      calc_window_residuals(times, y, 2.0, {{"first", 0.0, 5.0}, {"second", 5.0, times.back()}});
  CHECK(windows[0].count == 499);
  CHECK(windows[0].rms == 1.0);
  CHECK(windows[1].count == 500);  // the last sample included
  CHECK(windows[1].nrmse == 1.5);
}

TEST_CASE("A residual that is a function of a state is explained by it alone", "[property]") {
  std::vector<double> v, x, y;
  for (std::size_t i = 0; i < 20000; ++i) {
    const double t = static_cast<double>(i) * 1e-3;
    v.push_back(std::cos(2 * kPi * 1.0 * t));
    x.push_back(std::sin(2 * kPi * 1.0 * t));
    y.push_back(v.back() > 0.0 ? 2.0 : -1.0);
  }
  const StateResidual by_v = calc_state_residual("v", "m/s", v, y);
  const StateResidual by_x = calc_state_residual("x", "m", x, y);
  CHECK(by_v.mean_positive == Approx(2.0));
  CHECK(by_v.mean_negative == Approx(-1.0));
  CHECK(by_v.explained > 0.95);  // all but the bin that the jump falls into
  // The mean of 0.5 is all that x explains: 0.25 of a mean square of 2.5.
  CHECK(by_x.explained == Approx(0.1).margin(test::tolerance(0.01)));
  CHECK(by_x.bins.size() == kStateBins);
}

/// The body balance of the first run at the truth's linear parameters.
BodyBalance balance_truth(const test::QuarterTruth& truth, double tire_stiffness = 1300.0) {
  const test::TemporaryFolder folder;
  test::write_two_runs(folder, truth);
  test::CampaignText text;
  text.unsprung = "{ column = \"unsprung\", noise = 2e-6 }";
  text.sprung = "{ column = \"sprung\", noise = 2e-6 }";
  text.fit = "fix = { sprung_mass = 2.6, stiffness = 950, damping = 8, tire_stiffness = " +
             test::print_number(tire_stiffness) + " }\n";
  const CampaignData data = read_campaign_data(test::write_campaign(folder, text));
  const auto balance = calc_body_balance(data.runs[0]);
  REQUIRE(balance.has_value());
  return *balance;
}

TEST_CASE("The body balance closes for the right strut whatever the tire is", "[property]") {
  const BodyBalance right = balance_truth({});
  const BodyBalance wrong_tire = balance_truth({}, 1495.0);
  CHECK(right.nrmse < test::tolerance(0.01));
  CHECK(wrong_tire.nrmse < test::tolerance(0.01));
  // The filter is the same on both sides: no bias of stiffness or damping. What is left is that of
  // the rate, which the force takes at the smoothed deflection.
  CHECK(right.stiffness == Approx(950.0).epsilon(test::tolerance(0.005)));
  CHECK(right.damping == Approx(8.0).epsilon(test::tolerance(0.02)));
  test::QuarterTruth friction;
  friction.friction = 0.3;
  const BodyBalance rubbing = balance_truth(friction);
  CHECK(rubbing.nrmse > 10.0 * right.nrmse);
  const StateResidual& by_velocity = rubbing.states[1];
  CHECK(by_velocity.explained > 0.7);
  // Compression positive: friction pushes back, so the strut's force is larger then.
  CHECK(by_velocity.mean_positive > 0.1);
  CHECK(by_velocity.mean_negative < -0.1);
}

TEST_CASE("A model is adequate on its own data and not without its friction", "[statistical]") {
  for (const double friction : {0.0, 0.3}) {
    test::QuarterTruth truth;
    truth.noise = 2e-5;
    truth.friction = friction;
    const test::TemporaryFolder folder;
    test::write_two_runs(folder, truth);
    const CampaignData data = read_campaign_data(test::write_campaign(folder));
    const Comparison comparison = compare_campaign(data);
    CHECK(comparison.is_adequate() == (friction == 0.0));
    // The noise is estimated, to 4 %.
    CHECK(data.runs[0].channels[0].sigma == Approx(2e-5).epsilon(test::tolerance(0.12)));
    const ChannelComparison& sprung = comparison.runs[1].calibrated.channels[1];
    if (friction == 0.0) {
      CHECK(sprung.chi2_per_reading == Approx(1.0).margin(test::tolerance(0.15)));
      CHECK(comparison.runs[1].nominal.channels[1].rms > 5.0 * sprung.rms);
    } else {
      CHECK(sprung.chi2_per_reading > 2.0);
      CHECK(sprung.neighbor_correlation > 0.5);
    }
  }
}

}  // namespace
}  // namespace strut
