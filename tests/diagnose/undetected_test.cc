// What effects too small to be detected, and forces of unknown form, leave open.
#include "diagnose/decide/undetected.h"

#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>

#include "base/math/normal.h"
#include "base/math/random.h"
#include "tests/support/tolerance.h"

namespace strut {
namespace {

using test::tolerance;

constexpr double kMost = 12.0, kLeast = 0.3;  // sizes that count, in standard deviations

TEST_CASE("Without effects an interval is 1.96 standard errors to each side", "[unit]") {
  const Interval i = calc_averaged_interval(5.0, 2.0, 0, {});
  CHECK(i.low == Approx(5.0 - 3.919927969).epsilon(tolerance(1e-9)));
  CHECK(i.high == Approx(5.0 + 3.919927969).epsilon(tolerance(1e-9)));
}

TEST_CASE("An effect that may be there moves an interval to its side only", "[unit]") {
  const Interval none = calc_averaged_interval(0.0, 1.0, 0, {});
  const Interval seen = calc_averaged_interval(0.0, 1.0, 0, {{1.0, 3.0, true, {2.0}}});
  CHECK(seen.high > 4.0);  // towards 3 * 2
  CHECK(seen.high < 3.0 * 2.0 + 2.0 * std::hypot(1.0, 2.0));
  CHECK(seen.low == Approx(none.low).epsilon(tolerance(1e-9)));
  // A score of the other sign says that a one-sided effect is not there.
  const Interval refuted = calc_averaged_interval(0.0, 1.0, 0, {{1.0, -3.0, true, {2.0}}});
  CHECK(refuted.high < none.high + 0.1);
  const Interval mirrored = calc_averaged_interval(0.0, 1.0, 0, {{1.0, -3.0, false, {2.0}}});
  CHECK(mirrored.low < -3.0);
}

/// Draws of nothing or of one effect of any size, as often as the interval assumes.
TEST_CASE("Averaged intervals hold 95 % over all effects that may act", "[unit][statistical]") {
  constexpr int kDraws = 4000;
  constexpr double kShift = 3.0;  // standard errors per standard deviation of the effect
  const double acts = std::log(kMost / kLeast) / std::log(1e4);
  int held = 0, held_plain = 0, effects = 0;
  for (int i = 0; i < kDraws; ++i) {
    const auto uniform = [&](int k) {
      return calc_uniform(7, static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(k));
    };
    const bool is_there = uniform(0) < acts / (1.0 + acts);
    const double s = is_there ? kLeast * std::pow(kMost / kLeast, uniform(1)) : 0.0;
    const double score = s + calc_normal(8, static_cast<std::uint64_t>(i), 0);
    const double error = -s * kShift + calc_normal(8, static_cast<std::uint64_t>(i), 1);
    const Interval x = calc_averaged_interval(error, 1.0, 0, {{1.0, score, true, {kShift}}});
    held += x.low <= 0.0 && 0.0 <= x.high ? 1 : 0;
    held_plain += std::abs(error) <= kNormal95 ? 1 : 0;
    effects += is_there ? 1 : 0;
  }
  REQUIRE(effects > 0.2 * kDraws);
  CHECK(held_plain < 0.78 * kDraws);
  CHECK(held > 0.94 * kDraws);
  CHECK(held < 0.98 * kDraws);
}

/// Readings that respond to two unknowns and, in three columns, to effects.
struct Linear {
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(40, 6);
  Evidence evidence;

  /// `size`: of the first effect in the readings, no noise.
  explicit Linear(double size) {
    for (Eigen::Index i = 0; i < all.rows(); ++i) {
      for (Eigen::Index j = 0; j < 5; ++j) {
        all(i, j) = calc_normal(3, static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(j));
      }
    }
    all.col(4) = 2.0 * all.col(0) - all.col(1);  // what the unknowns can do, too
    const Eigen::VectorXd readings = size * all.col(2);
    const Eigen::MatrixXd j = all.leftCols(2);
    const Eigen::VectorXd fitted = j.colPivHouseholderQr().solve(readings);
    all.col(5) = j * fitted - readings;
    evidence.shared = 2;
    evidence.trials = {{0, 0, {0}, {0}}, {1, 0, {1}, {0}}, {2, 0, {2}, {0}}};
    evidence.products = {all.transpose() * all, Eigen::MatrixXd::Zero(6, 6)};
    evidence.norms = {all.middleCols(2, 3).colwise().squaredNorm().transpose()};
  }
};

TEST_CASE("An undetected effect's shift undoes what the effect did to the fit", "[unit]") {
  constexpr double kSize = 0.7;
  const Linear linear(kSize);
  std::vector<Unknown> unknowns(2);
  unknowns[0].scale = 3.0;
  const std::vector<Undetected> list = list_undetected(
      linear.evidence, calc_score(linear.evidence, {1.0}), {true, false, true}, unknowns, 1.0);
  REQUIRE(list.size() == 2);  // the third is nothing but the unknowns
  CHECK(list[0].one_sided);
  CHECK_FALSE(list[1].one_sided);
  CHECK(list[0].weight == Approx(1.0 / 3.0).epsilon(tolerance(1e-12)));
  // The readings were fitted with unknowns that are truly zero.
  const Eigen::MatrixXd j = linear.all.leftCols(2);
  const Eigen::VectorXd fitted = j.colPivHouseholderQr().solve(kSize * linear.all.col(2));
  CHECK(3.0 * fitted(0) + list[0].score * list[0].shift[0] == Approx(0.0).margin(tolerance(1e-9)));
  CHECK(fitted(1) + list[0].score * list[0].shift[1] == Approx(0.0).margin(tolerance(1e-9)));
  // Noise of four times the variance: half as many standard deviations, each twice as far.
  const std::vector<Undetected> noisy = list_undetected(
      linear.evidence, calc_score(linear.evidence, {1.0}), {true, false, true}, unknowns, 4.0);
  CHECK(noisy[0].score == Approx(0.5 * list[0].score).epsilon(tolerance(1e-12)));
  CHECK(noisy[0].shift[0] == Approx(2.0 * list[0].shift[0]).epsilon(tolerance(1e-12)));
}

TEST_CASE("A form error is a value's change by which its readings move eight times the residual",
          "[unit]") {
  constexpr double kEnergy = 2.5, kPrior = 0.2;
  const Eigen::MatrixXd j = Linear(0.0).all.leftCols(2);
  Eigen::MatrixXd information = j.transpose() * j;
  information(1, 1) += 1.0 / (kPrior * kPrior);
  FitResult fit;
  fit.unknowns.resize(2);
  fit.unknowns[1].prior = {0.0, kPrior};
  fit.uncertainty.covariance = information.inverse();
  fit.values = {1e3, 1e3};
  const std::vector<double> errors = calc_form_errors(fit, 2, kEnergy);
  for (const Eigen::Index i : {0, 1}) {
    CHECK((j.col(i) * errors[static_cast<std::size_t>(i)]).squaredNorm() ==
          Approx(64.0 * kEnergy).epsilon(tolerance(1e-9)));
  }
  fit.values[1] = -1e-3;
  CHECK(calc_form_errors(fit, 2, kEnergy)[1] == Approx(0.05e-3).epsilon(tolerance(1e-12)));
  CHECK(calc_form_errors(fit, 2, 0.0) == std::vector<double>{0.0, 0.0});
}

}  // namespace
}  // namespace strut
