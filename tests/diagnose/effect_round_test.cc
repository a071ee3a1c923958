// Threshold and negligible effects of a round, in closed form.
#include "diagnose/decide/effect_round.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "tests/support/campaign_files.h"
#include "tests/support/linear_model.h"
#include "tests/support/tolerance.h"
#include "tests/support/unit_noise.h"

namespace strut {
namespace {

using test::tolerance;

/// One hypothesis of one column without the model's parameters.
struct OneHypothesis {
  Evidence evidence;
  Score score;

  OneHypothesis() {
    evidence.trials = {{0, 0, {0}, {0}}};
    score.covariance = Eigen::MatrixXd::Constant(1, 1, 7.0);
    score.norm = Eigen::VectorXd::Constant(1, 7.0);
    score.gradient = Eigen::VectorXd::Zero(1);
  }

  NullScores draw(const SelectOptions& options) const {
    return draw_null_scores(evidence, score, {false}, options.nulls);
  }
};

TEST_CASE("The threshold of false alarms is what the nulls give, with the margin", "[unit]") {
  const OneHypothesis one;
  SelectOptions options;
  options.nulls = 20000;
  options.confidence = 0.99;
  options.margin = 1.25;
  const double threshold = calc_threshold(one.draw(options), options, 0.0);
  // 99 % quantile of chi2 with one degree of freedom; 4 sigmas of 20000 draws are 0.4.
  CHECK(threshold == Approx(1.25 * 6.635).margin(tolerance(0.5)));
  // Null data sets of the test's own: z / sqrt(K) is standard normal.
  int alarms = 0;
  constexpr int kSets = 20000;
  for (std::uint64_t i = 0; i < kSets; ++i) {
    const double z = test::calc_test_normal(77, 0, i);
    alarms += z * z > threshold / options.margin ? 1 : 0;
  }
  // 200 expected; 1 sigma of the alarms and of the threshold together is 20.
  CHECK(alarms == Approx(200).margin(tolerance(80.0)));
}

TEST_CASE("By default one null data set in a thousand exceeds the threshold without its margin",
          "[unit]") {
  const OneHypothesis one;
  SelectOptions options;
  options.nulls *= 20;
  // 99.9 % quantile of chi2 with one degree of freedom; 4 sigmas of 40000 draws are 1.2.
  CHECK(calc_threshold(one.draw(options), options, 0.0) ==
        Approx(1.25 * 10.828).margin(tolerance(1.5)));
}

TEST_CASE("What is negligible is below every threshold", "[unit]") {
  const OneHypothesis one;
  SelectOptions options;
  options.nulls = 100;
  CHECK(calc_threshold(one.draw(options), options, 500.0) == 500.0);
}

/// 60 readings of one channel with a sigma of 2, beside a road of 4 times their power.
Whitener make_whitener() {
  constexpr std::size_t kSamples = 60;
  NoiseSpectrum noise = test::make_unit_noise(kSamples);
  noise.sigma = {2.0};
  noise.level = 8.0;
  noise.common.assign(kSamples / 2 + 1, Eigen::MatrixXcd::Constant(1, 1, 2.0));
  const test::LinearModel model({test::make_plain_unknown("p")}, Eigen::MatrixXd::Ones(kSamples, 1),
                                Eigen::VectorXd::Zero(kSamples));
  return {model, {noise}};
}

TEST_CASE("A cause explains more than a fraction of the noise's power", "[unit]") {
  const Whitener whitener = make_whitener();
  REQUIRE(whitener.whitened_count() == 60);
  CHECK(calc_negligible(true, {}, whitener) == Approx(60 * 1e-3).epsilon(tolerance(1e-12)));
  CHECK(calc_negligible(false, {}, whitener) ==
        Approx(60 * (2.5e-3 + 4.0 * 3e-5)).epsilon(tolerance(1e-12)));
}

}  // namespace
}  // namespace strut
