// The roughness of a road by what a car reads on level ground, or before its bump.
#include "diagnose/noise/roughness.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "tests/support/campaign_files.h"
#include "tests/support/common_noise.h"
#include "tests/support/test_car.h"

namespace strut {
namespace {

using test::ConstantModel, test::get_weight, test::kChannels, test::kInterval, test::kSamples,
    test::make_spectrum;

TEST_CASE("The roughness of several level runs is that of a quiet one", "[unit]") {
  // Levels in units of 1e-5 m^3, by run.
  const std::vector<double> levels = {100.0, 1.0, 10.0, 0.1};
  const std::size_t runs = levels.size();
  const ConstantModel model(runs);
  std::vector<NoiseSpectrum> spectra(runs, make_spectrum());
  for (NoiseSpectrum& s : spectra) {
    for (Eigen::MatrixXcd& common : s.common) common *= 1e5;
  }
  Eigen::VectorXd residual(static_cast<Eigen::Index>(runs * kSamples * kChannels));
  Eigen::Index row = 0;
  for (std::size_t r = 0; r < runs; ++r) {
    for (std::size_t t = 0; t < kSamples; ++t) {
      for (std::size_t c = 0; c < kChannels; ++c) {
        const double source = test::calc_test_normal(r, 99, (t + kSamples - c) % kSamples);
        residual(row++) =
            test::calc_test_normal(r, c, t) + std::sqrt(levels[r]) * get_weight(c) * source;
      }
    }
  }
  const Roughness roughness =
      fit_roughness(model, spectra, std::vector<bool>(runs, true), residual);
  // The second lowest of four; levels are tried in steps of 1.8, and 240 samples know it to 10 %.
  CHECK(roughness.level > 0.5e-5);
  CHECK(roughness.level < 2e-5);
}

/// Runs that meet a bump after 160 of their 240 samples; half the bump and the contact patch come
/// before its center.
CampaignData make_crossings(std::size_t runs) {
  MeasuredRun run{"crossing", Model(test::make_paper_case()), {}, {}};
  ManeuverSpec& m = run.setup.car().maneuver;
  m = test::make_gentle_maneuver();
  m.speed = 10.0;
  m.bump_distance = 15.95 + 0.5 * m.road.length + 0.1;
  for (std::size_t t = 0; t < kSamples; ++t) {
    run.times.push_back(kInterval * static_cast<double>(t));
  }
  CampaignData data;
  data.campaign.info = &get_car_info();
  for (std::size_t r = 0; r < runs; ++r) {
    data.campaign.runs.emplace_back();
    data.tables.emplace_back();
    data.runs.push_back(run);
  }
  return data;
}

/// White noise of 1 sigma and `extra` variance before the bump, by channel; behind it, of `behind`
/// sigmas. A constant offset beside it.
Eigen::VectorXd draw_crossings(std::size_t runs, const std::vector<double>& extra, double behind) {
  Eigen::VectorXd residual(static_cast<Eigen::Index>(runs * kSamples * kChannels));
  Eigen::Index row = 0;
  for (std::size_t r = 0; r < runs; ++r) {
    for (std::size_t t = 0; t < kSamples; ++t) {
      for (std::size_t c = 0; c < kChannels; ++c) {
        const double sigma = t < 160 ? std::sqrt(1.0 + extra[c]) : behind;
        residual(row++) = 5.0 + sigma * test::calc_test_normal(r, c, t);
      }
    }
  }
  return residual;
}

TEST_CASE("Before a bump, the road is what the channels' mean squares have beyond their sensors'",
          "[unit]") {
  constexpr std::size_t kRuns = 9;
  const CampaignData data = make_crossings(kRuns);
  const ConstantModel model(kRuns);
  std::vector<std::size_t> runs;
  for (std::size_t r = 0; r < kRuns; ++r) runs.push_back(r);
  // A source of 1 has weights of 3, 5 and 7, so a road of level G adds 9 G, 25 G and 49 G to the
  // variances; the last channel has something else besides, and the median leaves it alone.
  constexpr double kLevel = 2.0;
  const std::vector<double> extra = {9.0 * kLevel, 25.0 * kLevel, 49.0 * kLevel + 5000.0};
  std::vector<NoiseSpectrum> spectra(kRuns, make_spectrum());
  REQUIRE(calc_common_variance(spectra.front(), 1) == Approx(25.0).epsilon(test::tolerance(1e-9)));
  const Roughness found =
      measure_roughness(data, runs, model, spectra, draw_crossings(kRuns, extra, 100.0));
  // The larger of two mean squares of 160 numbers, 11 % each, is 6 % above their mean; the median
  // of nine runs scatters by 4 %.
  CHECK(found.level == Approx(kLevel).epsilon(test::tolerance(0.2)));
  CHECK(found.response_error == 0.02);
  const Roughness none =
      measure_roughness(data, runs, model, spectra, draw_crossings(kRuns, {0.0, 0.0, 0.0}, 100.0));
  // The median of three, 0.11 over 9, 25 and 49, is below 0.11 / 25; 4 sigma.
  CHECK(none.level == Approx(0.0).margin(test::tolerance(0.018)));
}

TEST_CASE("A run on level ground alone tells how rough the road is", "[unit]") {
  CampaignData data = make_crossings(2);
  data.runs[1].setup.car().maneuver.road.height = 0.0;
  const ConstantModel model(2);
  const std::vector<NoiseSpectrum> spectra(2, make_spectrum());
  const Eigen::VectorXd residual = draw_crossings(2, {20.0, 20.0, 20.0}, 4.0);
  const Roughness found = measure_roughness(data, {0, 1}, model, spectra, residual);
  const Roughness expected = fit_roughness(model, spectra, {false, true}, residual);
  CHECK(found.level == expected.level);
  CHECK(found.response_error == expected.response_error);
  CHECK(found.level != measure_roughness(data, {0}, model, spectra, residual).level);
}

TEST_CASE("A run whose bump comes at once is ignored", "[unit]") {
  CampaignData data = make_crossings(1);
  ManeuverSpec& m = data.runs[0].setup.car().maneuver;
  m.bump_distance -= 12.0;  // 40 samples are left
  const std::vector<NoiseSpectrum> spectra = {make_spectrum()};
  const Roughness found = measure_roughness(data, {0}, ConstantModel(1), spectra,
                                            draw_crossings(1, {90.0, 90.0, 90.0}, 10.0));
  CHECK(found.level == 0.0);
}

}  // namespace
}  // namespace strut
