// A car's springs and dampers on a rough road that nobody measured, against a truth by Newton
// closure and short steps over a road of random harmonics.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "diagnose/noise/whitened_fit.h"
#include "tests/support/fit_case.h"

namespace strut {
namespace {

using test::tolerance;

constexpr double kLevel = 1.6e-5;  // m^3, G0 of the truth
constexpr double kRate = 200.0;    // readings a second
constexpr double kSpacing = 0.05;  // m, of the truth's tracks

/// A track of ISO 8608 with amplitudes of its density and random phases; long waves, below 0.3 1/m,
/// lift both tracks alike.
RoughTrack make_harmonic_track(double begin, double end, std::uint64_t side) {
  constexpr double kStep = 0.02, kHighest = 2.5, kAlike = 0.3;  // 1/m
  RoughTrack track{begin, kSpacing, {}};
  const auto count = static_cast<int>((end - begin) / kSpacing);
  for (int i = 0; i < count; ++i) {
    const double x = begin + kSpacing * (i + 2);
    double z = 0.0;
    for (int k = 1; k * kStep < kHighest; ++k) {
      const double n = kStep * k;
      const double amplitude = std::sqrt(2.0 * kLevel * 0.01 / (n * n) * kStep);
      const std::uint64_t seed = n < kAlike ? 7 : 8 + side;
      const double phase = 10.0 * test::calc_test_normal(seed, 0, static_cast<std::uint64_t>(k));
      z += amplitude * std::cos(2.0 * std::numbers::pi * n * x + phase);
    }
    track.coefficients.push_back(z);
  }
  return track;
}

/// Over a bump from which no wheel lifts off, without torque: the same speed at the bump whatever
/// the lead.
Case make_new_case() {
  Case c = test::make_paper_case();
  c.maneuver = test::make_gentle_maneuver();
  c.maneuver.duration = 1.3;
  c.maneuver.drive_torque = 0.0;
  return c;
}

Case make_worn_case() {
  Case c = make_new_case();
  for (const char* name : {"front_damping", "rear_stiffness"}) {
    set_parameter(c, name, 0.9 * find_parameter(name).get(c));
  }
  return c;
}

/// What the sensors read of a worn car; the setup is that of a new one.
MeasuredRun drive_rough_road() {
  Case truth = make_worn_case();
  ManeuverSpec& m = truth.maneuver;
  constexpr double kLead = 1.5;  // s, more than a fit's
  m.lead_time = kLead;
  m.duration += kLead;
  const double begin = -m.bump_distance - kLead * m.speed - 5.0, end = 30.0;
  m.rough = {make_harmonic_track(begin, end, 0), make_harmonic_track(begin, end, 1)};
  const LaneResults results = test::simulate_truth(truth, kRate, false);
  MeasuredRun run{"rough", make_new_case(), {}, {}};
  constexpr int kBefore = static_cast<int>(kLead * kRate);
  const std::pair<const char*, double> sensors[] = {{"imu_acceleration_z", 0.02},
                                                    {"imu_rate_y", 1e-3},
                                                    {"front_left_suspension_deflection", 3e-4},
                                                    {"front_right_suspension_deflection", 3e-4},
                                                    {"rear_left_suspension_deflection", 3e-4},
                                                    {"rear_right_suspension_deflection", 3e-4}};
  for (int i = kBefore; i < results.sample_count; ++i) run.times.push_back((i - kBefore) / kRate);
  std::uint64_t number = 20;
  for (const auto& [name, sigma] : sensors) {
    MeasuredChannel c{find_channel(get_car_info(), name), sigma, {}};
    ++number;
    for (int i = kBefore; i < results.sample_count; ++i) {
      c.values.push_back(results.get_sample(i, c.channel) +
                         sigma * test::calc_test_normal(number, 0, static_cast<std::uint64_t>(i)));
    }
    run.channels.push_back(std::move(c));
  }
  return run;
}

CampaignData make_rough_campaign() {
  CampaignData data;
  data.campaign.info = &get_car_info();
  data.campaign.runs.emplace_back();
  data.tables.emplace_back();
  data.runs = {drive_rough_road()};
  return data;
}

/// The level of a road that is wrong by a factor of 4, and drift of white sensors.
NoiseSpectrum make_first_guess(const CampaignData& data) {
  NoiseSpectrum s;
  s.samples = find_quick_length(data.times(0).size());
  s.interval = 1.0 / kRate;
  for (const MeasuredChannel& c : data.channels(0)) {
    s.sigma.push_back(c.sigma);
    s.color.push_back({c.channel, 8.0, {}});
  }
  s.level = kLevel / 4.0;
  return s;
}

TEST_CASE("A rough road under a car is found together with its springs and dampers",
          "[unit][slow]") {
  const CampaignData data = make_rough_campaign();
  const std::vector<Unknown> unknowns = test::make_suspension(data.runs);
  const WhitenedFit fit =
      fit_whitened(data, {0}, {{make_first_guess(data)}, make_smooth_roads(data, {0})}, unknowns,
                   list_starts(unknowns), unknowns.size(), 2);
  CHECK(fit.fit.converged);
  // The truth's tracks are not as alike as those of an isotropic road.
  CHECK(fit.fit.chi2_per_degree() == Approx(1.0).margin(tolerance(0.3)));
  const Case truth = make_worn_case();
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    CAPTURE(unknowns[i].name, fit.fit.values[i], fit.fit.uncertainty.sigma[i]);
    const double value = find_parameter(unknowns[i].name).get(truth);
    CHECK(std::abs(fit.fit.values[i] - value) < 4.0 * fit.fit.uncertainty.sigma[i]);
    CHECK(fit.fit.uncertainty.sigma[i] < tolerance(0.02) * value);
  }
  for (const SensorColor& color : fit.spectra.front().color) CHECK(color.corner < 1.0);
  // 2 x 300 weights tell the level within a tenth; harmonics above 2.5 1/m are absent.
  CHECK(fit.spectra.front().level / kLevel > 0.6);
  CHECK(fit.spectra.front().level / kLevel < 1.5);
}

}  // namespace
}  // namespace strut
