// Reported errors of fits against their actual errors.

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>

#include "base/math/normal.h"
#include "base/math/random.h"
#include "tests/support/campaign_files.h"
#include "tests/support/fit_case.h"

namespace strut {
namespace {

/// Readings with noise of a worn car whose unknowns are drawn from their priors.
struct Trial {
  Case truth;
  test::Distortion distortion;
};

Trial draw(std::uint64_t seed) {
  Trial trial{test::make_paper_case(), {}};
  const double losses[] = {4500.0, 180.0, 4500.0, 180.0};
  for (std::size_t i = 0; i < 4; ++i) {
    const std::string& name = test::suspension_names()[i];
    const double value = get_parameter(trial.truth, name) - losses[i] * calc_uniform(seed, 10, i);
    set_parameter(trial.truth, name, value);
  }
  set_parameter(trial.truth, "speed", 20.0 + 0.2 * test::calc_test_normal(seed, 11, 0));
  trial.truth.maneuver.duration = 1.3;
  trial.distortion = {0.005 * test::calc_test_normal(seed, 11, 1),
                      0.3 * test::calc_test_normal(seed, 11, 2),
                      0.02 * test::calc_test_normal(seed, 11, 3), 1.0, seed};
  return trial;
}

/// Errors by the Cramer-Rao bound at the truth.
Eigen::Array4d calc_ratios(const Trial& trial, const FitResult& fit, const MeasuredRun& measured) {
  MeasuredRun run = measured;
  run.setup = trial.truth;
  const Uncertainty bounds = calc_fit_bounds({run}, test::make_all_unknowns({run}));
  Eigen::Array4d ratios;
  for (int p = 0; p < 4; ++p) {
    const auto at = static_cast<std::size_t>(p);
    const double truth = get_parameter(trial.truth, fit.unknowns[at].name);
    ratios(p) = (fit.values[at] - truth) / bounds.sigma[at];
  }
  return ratios;
}

TEST_CASE("Fits of MEMS sensors' readings reach the Cramer-Rao bound and know their errors",
          "[statistical][slow]") {
  constexpr int kTrials = 40;
  double distance = 0.0, chi2 = 0.0;  // e' C^-1 e of the four parameters
  Eigen::Array4d squares = Eigen::Array4d::Zero();
  int covered = 0;
  for (int i = 0; i < kTrials; ++i) {
    const Trial trial = draw(100 + static_cast<std::uint64_t>(i));
    const std::vector<MeasuredRun> runs{
        test::measure(test::make_known_case(), trial.truth, trial.distortion)};
    const FitResult fit = fit_simulation(runs, test::make_all_unknowns(runs));
    INFO("trial " << i);
    REQUIRE(fit.converged);
    Eigen::Vector4d error;
    for (int p = 0; p < 4; ++p) {
      const auto at = static_cast<std::size_t>(p);
      error(p) = fit.values[at] - get_parameter(trial.truth, fit.unknowns[at].name);
      covered += std::abs(error(p)) < kNormal95 * fit.uncertainty.sigma[at] ? 1 : 0;
    }
    const Eigen::Matrix4d covariance = fit.uncertainty.covariance.topLeftCorner(4, 4);
    distance += error.dot(covariance.inverse() * error);
    squares += calc_ratios(trial, fit, runs[0]).square();
    chi2 += fit.chi2_per_degree();
  }
  // The requirement; one sigma of a ratio is 1 / sqrt(2 kTrials) = 11 %.
  for (int p = 0; p < 4; ++p) {
    INFO(test::suspension_names()[static_cast<std::size_t>(p)]);
    CHECK(std::sqrt(squares(p) / kTrials) < 1.25);
    CHECK(std::sqrt(squares(p) / kTrials) > 0.65);
  }
  // Sums of 160 squares of standard normal numbers: 160 +/- 4 sqrt(320); of 160 intervals of 95 %
  // 152 +/- 4 * 2.8 hold the truth.
  CHECK(distance == Approx(4.0 * kTrials).margin(4.0 * std::sqrt(8.0 * kTrials)));
  CHECK(covered >= 141);
  CHECK(chi2 / kTrials == Approx(1.0).margin(4.0 * std::sqrt(2.0 / 500.0 / kTrials)));
}

}  // namespace
}  // namespace strut
