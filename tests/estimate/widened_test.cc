// Standard errors widened by residuals larger than noise, in closed form.
#include <catch2/catch.hpp>
#include <cmath>

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

}  // namespace
}  // namespace strut
