// Intervals that allow for effects too small to be detected and for forces of unknown form.
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

constexpr double kMax = 12.0, kMin = 0.3;  // sizes that count, in standard deviations

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

/// The quantile of the averaged distribution, by sums over a fine grid of sizes and values.
double integrate_quantile(const std::vector<Undetected>& effects, double p) {
  constexpr int kSizes = 4000, kValues = 8001;
  constexpr double kReach = 60.0, kLast = 30.0;
  std::vector<double> density(kValues, 0.0);
  const auto add = [&](double weight, double middle) {
    for (int k = 0; k < kValues; ++k) {
      const double z = kReach * (2.0 * k / (kValues - 1) - 1.0) - middle;
      if (std::abs(z) < 8.0)
        density[static_cast<std::size_t>(k)] += weight * std::exp(-0.5 * z * z);
    }
  };
  add(1.0, 0.0);
  const double step = std::log(kLast / kMin) / kSizes;
  for (const Undetected& u : effects) {
    for (int k = 0; k < kSizes; ++k) {
      const double s = kMin * std::exp((k + 0.5) * step);
      const double weight = u.prior * step / std::log(1e4);
      for (const double size : {s, -s}) {
        if (u.one_sided && size < 0.0) continue;
        add((u.one_sided ? 1.0 : 0.5) * weight * std::exp(size * u.score - 0.5 * s * s),
            size * u.shift[0]);
      }
    }
  }
  double sum = 0.0, below = 0.0;
  for (const double d : density) sum += d;
  for (int k = 0; k < kValues; ++k) {
    below += density[static_cast<std::size_t>(k)];
    if (below >= p * sum) return kReach * (2.0 * k / (kValues - 1) - 1.0);
  }
  return kReach;
}

TEST_CASE("The averaged interval is that of the integral over sizes", "[unit]") {
  const std::vector<std::vector<Undetected>> cases = {
      {{1.0, 1.0, true, {3.0}}},
      {{0.5, 2.5, false, {-1.0}}, {0.3, -1.0, false, {4.0}}, {0.2, 0.5, true, {0.3}}},
      {{0.1, 3.5, true, {2.0}}, {0.9, 0.0, false, {1.5}}}};
  for (const std::vector<Undetected>& effects : cases) {
    const Interval i = calc_averaged_interval(0.0, 1.0, 0, effects);
    CHECK(i.low ==
          Approx(std::min(-kNormal95, integrate_quantile(effects, 0.025))).margin(tolerance(0.15)));
    CHECK(i.high ==
          Approx(std::max(kNormal95, integrate_quantile(effects, 0.975))).margin(tolerance(0.15)));
  }
}

TEST_CASE("An effect of any score moves an interval by what it is likely to be", "[unit]") {
  for (const double score : {12.0, 72.0, 300.0, 1e4}) {
    const Interval i = calc_averaged_interval(0.0, 1.0, 0, {{1.0, score, true, {0.5}}});
    // Its size is known within 1, in addition to the value itself.
    const double expected = 0.5 * score + kNormal95 * std::hypot(1.0, 0.5);
    CHECK(i.high == Approx(expected).margin(tolerance(0.15)));
    CHECK(i.low == Approx(-kNormal95).epsilon(tolerance(1e-9)));
  }
}

/// Draws of no effect or of one of any size, as often as the interval assumes.
TEST_CASE("Averaged intervals hold 95 % over all effects that may act", "[unit][statistical]") {
  constexpr int kDraws = 4000;
  constexpr double kShift = 3.0;  // standard errors per standard deviation of the effect
  const double acts = std::log(kMax / kMin) / std::log(1e4);
  int held = 0, held_plain = 0, effects = 0;
  for (int i = 0; i < kDraws; ++i) {
    const auto uniform = [&](int k) {
      return calc_uniform(7, static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(k));
    };
    const bool is_there = uniform(0) < acts / (1.0 + acts);
    const double s = is_there ? kMin * std::pow(kMax / kMin, uniform(1)) : 0.0;
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
  const std::vector<Undetected> list =
      list_undetected(linear.evidence, {true, false, true}, unknowns, 1.0);
  REQUIRE(list.size() == 2);  // the third is nothing but the unknowns
  CHECK(list[0].one_sided);
  CHECK_FALSE(list[1].one_sided);
  CHECK(list[0].prior == Approx(1.0 / 3.0).epsilon(tolerance(1e-12)));
  // The readings were fitted with unknowns that are truly zero.
  const Eigen::MatrixXd j = linear.all.leftCols(2);
  const Eigen::VectorXd fitted = j.colPivHouseholderQr().solve(kSize * linear.all.col(2));
  CHECK(3.0 * fitted(0) + list[0].score * list[0].shift[0] == Approx(0.0).margin(tolerance(1e-9)));
  CHECK(fitted(1) + list[0].score * list[0].shift[1] == Approx(0.0).margin(tolerance(1e-9)));
  // Noise of four times the variance: half as many standard deviations, each twice as far.
  const std::vector<Undetected> noisy =
      list_undetected(linear.evidence, {true, false, true}, unknowns, 4.0);
  CHECK(noisy[0].score == Approx(0.5 * list[0].score).epsilon(tolerance(1e-12)));
  CHECK(noisy[0].shift[0] == Approx(2.0 * list[0].shift[0]).epsilon(tolerance(1e-12)));
}

TEST_CASE("A form error is the change of a value that fits eight times the residual", "[unit]") {
  constexpr double kEnergy = 2.5, kPrior = 0.2;
  // As stiffnesses and clocks: units that differ by nine orders of magnitude.
  Eigen::MatrixXd j = Linear(0.0).all.leftCols(2);
  j.col(0) *= 1e-3;
  j.col(1) *= 1e6;
  Eigen::MatrixXd information = j.transpose() * j;
  information(1, 1) += 1e12 / (kPrior * kPrior);
  FitResult fit;
  fit.unknowns.resize(2);
  fit.unknowns[1].prior = {0.0, 1e-6 * kPrior};
  fit.uncertainty.covariance = information.inverse();
  fit.values = {1e9, 1.0};
  const std::vector<double> errors = calc_form_errors(fit, 2, kEnergy);
  for (const Eigen::Index i : {0, 1}) {
    // The least squares of one value, the other held, to readings along its own column.
    const Eigen::VectorXd unseen = 8.0 * std::sqrt(kEnergy) * j.col(i).normalized();
    const double moved = j.col(i).dot(unseen) / information(i, i);
    CHECK(errors[static_cast<std::size_t>(i)] == Approx(moved).epsilon(tolerance(1e-6)));
  }
  fit.values[0] = -1e-3;
  CHECK(calc_form_errors(fit, 2, kEnergy)[0] == Approx(0.05e-3).epsilon(tolerance(1e-12)));
  CHECK(calc_form_errors(fit, 2, 0.0) == std::vector<double>{0.0, 0.0});
  // A value that only its prior knows does not follow the readings.
  fit.uncertainty.covariance(1, 1) = 1e-12 * kPrior * kPrior;
  fit.uncertainty.covariance(0, 1) = fit.uncertainty.covariance(1, 0) = 0.0;
  CHECK(calc_form_errors(fit, 2, kEnergy)[1] < 1e-3 * 1e-6 * kPrior);
}

}  // namespace
}  // namespace strut
