// Standard errors widened by residuals larger than noise, in closed form.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "estimate/fit.h"
#include "tests/support/linear_model.h"
#include "tests/support/tolerance.h"

namespace strut {
namespace {

using test::tolerance;

constexpr int kReadings = 50;
constexpr double kPriorSigma = 0.2;

/// A fit of a constant, known to 0.2 by its prior, to 50 readings that all have this residual.
FitResult fit_constant(double residual, UnknownKind kind = UnknownKind::kParameter) {
  Unknown constant = test::make_plain_unknown("constant");
  constant.kind = kind;
  constant.prior = {0.0, kPriorSigma};
  test::LinearModel model({constant}, Eigen::MatrixXd::Ones(kReadings, 1),
                          Eigen::VectorXd::Constant(kReadings, residual));
  return describe_fit(model, model.linearize({0.0}), {0.0}, {false}, false);
}

double calc_sigma(double of_readings, double of_priors) {
  return 1.0 / std::sqrt(of_readings + of_priors);
}

TEST_CASE("Residuals larger than noise divide the weight of the readings, not of the priors",
          "[unit]") {
  const FitResult fit = fit_constant(3.0);
  CHECK(fit.chi2_per_degree() == Approx(9.0).epsilon(tolerance(1e-12)));
  CHECK(fit.uncertainty.sigma[0] == Approx(calc_sigma(50.0, 25.0)).epsilon(tolerance(1e-9)));
  CHECK(fit.widened.sigma[0] == Approx(calc_sigma(50.0 / 9.0, 25.0)).epsilon(tolerance(1e-9)));
}

TEST_CASE("Residuals smaller than noise narrow no standard error", "[unit]") {
  const FitResult fit = fit_constant(0.3);
  CHECK(fit.chi2_per_degree() == Approx(0.09).epsilon(tolerance(1e-12)));
  CHECK(fit.widened.sigma[0] == Approx(calc_sigma(50.0, 25.0)).epsilon(tolerance(1e-9)));
}

TEST_CASE("The prior of a force map is in units of the residual", "[unit]") {
  const FitResult fit = fit_constant(3.0, UnknownKind::kForceMap);
  CHECK(fit.widened.sigma[0] ==
        Approx(calc_sigma(50.0 / 9.0, 25.0 / 9.0)).epsilon(tolerance(1e-9)));
}

/// A slope fitted to readings most of whose information is in the first tenth.
struct SlopeFits {
  double spread = 0.0, stated = 0.0;  // of the estimates; root mean square of the widened sigma
};

SlopeFits fit_slopes(double noise_of_first) {
  constexpr int kFits = 400, kCount = 1000, kFirst = 100;
  std::mt19937 random(20261128);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Constant(kCount, 1, 0.1);
  matrix.topRows(kFirst).setOnes();
  SlopeFits fits;
  for (int i = 0; i < kFits; ++i) {
    Eigen::VectorXd offset(kCount);
    for (int k = 0; k < kCount; ++k)
      offset(k) = (k < kFirst ? noise_of_first : 1.0) * normal(random);
    test::LinearModel model({test::make_plain_unknown("slope")}, matrix, offset);
    const double slope = -matrix.col(0).dot(offset) / matrix.col(0).squaredNorm();
    const FitResult fit = describe_fit(model, model.linearize({slope}), {slope}, {false}, false);
    fits.spread += slope * slope / kFits;
    fits.stated += fit.widened.sigma[0] * fit.widened.sigma[0] / kFits;
  }
  return {std::sqrt(fits.spread), std::sqrt(fits.stated)};
}

TEST_CASE("A residual that is larger where an unknown is decided widens its standard error",
          "[statistical]") {
  // 400 estimates give their spread within 3.5 %; from chi2 alone, the stated error is 0.4 of it.
  const SlopeFits uneven = fit_slopes(4.0);
  CHECK(uneven.stated > 0.9 * uneven.spread);
  CHECK(uneven.stated < 1.1 * uneven.spread);
  const SlopeFits even = fit_slopes(1.0);
  CHECK(even.stated == Approx(1.0 / std::sqrt(109.0)).epsilon(0.01));
  CHECK(even.stated == Approx(even.spread).epsilon(0.1));
}

TEST_CASE("A prior bounds the standard error that an uneven residual widens", "[unit]") {
  Unknown u = test::make_plain_unknown("offset");
  u.prior = {0.0, 1.0};
  // 40 readings that decide it, with residuals six times as large as the other 1960.
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(2000, 1);
  Eigen::VectorXd offset = Eigen::VectorXd::Ones(2000);
  for (int k = 0; k < 40; ++k) {
    matrix(k, 0) = 0.05;
    offset(k) = k % 2 == 0 ? 6.0 : -6.0;
  }
  test::LinearModel model({u}, matrix, offset);
  const FitResult fit = describe_fit(model, model.linearize({0.0}), {0.0}, {false}, false);
  CHECK(fit.widened.sigma[0] == Approx(1.0).epsilon(tolerance(1e-9)));
  CHECK(fit.widened.null_directions.empty());
}

TEST_CASE("A reading that one unknown follows alone widens nothing", "[unit]") {
  // The first unknown has a reading of its own, from which the search stopped a little away.
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(1001, 2);
  matrix(0, 0) = 1e4;
  matrix.bottomRows(1000).col(1).setOnes();
  Eigen::VectorXd offset(1001);
  for (int k = 0; k < 1001; ++k) offset(k) = k % 2 == 0 ? 1.0 : -1.0;
  offset(0) = 0.05;
  test::LinearModel model({test::make_plain_unknown("own"), test::make_plain_unknown("shared")},
                          matrix, offset);
  const FitResult fit =
      describe_fit(model, model.linearize({0.0, 0.0}), {0.0, 0.0}, {false, false}, false);
  CHECK(fit.widened.sigma[0] == Approx(1e-4).epsilon(1e-2));
}

TEST_CASE("What the readings do not identify stays a ratio where one residual is uneven",
          "[unit]") {
  // Only the sum of two unknowns is read; a third, beside them, is decided by large residuals.
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(1000, 3);
  matrix.leftCols(2).bottomRows(900).setOnes();
  matrix.col(2).head(100).setOnes();
  Eigen::VectorXd offset(1000);
  for (int k = 0; k < 1000; ++k) offset(k) = (k % 2 == 0 ? 1.0 : -1.0) * (k < 100 ? 5.0 : 1.0);
  test::LinearModel model(
      {test::make_plain_unknown("a"), test::make_plain_unknown("b"), test::make_plain_unknown("c")},
      matrix, offset);
  const FitResult fit = describe_fit(model, model.linearize({0.0, 0.0, 0.0}), {0.0, 0.0, 0.0},
                                     {false, false, false}, false);
  REQUIRE(fit.widened.null_directions.size() == 1);
  const std::vector<double>& parts = fit.widened.null_directions[0].parts;
  CHECK(parts[0] == Approx(-parts[1]).epsilon(tolerance(1e-9)));
  CHECK(std::abs(parts[2]) < tolerance(1e-9));
  CHECK(fit.widened.sigma[2] > 2.0 * fit.uncertainty.sigma[2]);
}

}  // namespace
}  // namespace strut
