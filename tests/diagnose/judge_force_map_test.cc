// The rules that accept a force map, each on both sides of its limit; the standard error of a map.
#include "diagnose/decide/judge_force_map.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <memory>

#include "tests/support/tolerance.h"

namespace strut {
namespace {

using test::tolerance;

/// Held-out runs of 1000 readings.
HoldOutSum make_sum(double chi2, double log_likelihood) {
  HoldOutRun run;
  run.chi2 = chi2;
  run.log_likelihood = log_likelihood;
  run.expected = 1000.0;
  return HoldOutSum({run});
}

TEST_CASE("Held-out runs are summed, and a failed one leaves the sum incomplete", "[unit]") {
  HoldOutRun a, b;
  a.chi2 = 3.0;
  b.chi2 = 9.0;
  a.log_likelihood = -1.0;
  b.log_likelihood = -2.0;
  a.expected = b.expected = 4.0;
  const HoldOutSum sum({a, b});
  CHECK(sum.is_whole);
  CHECK(sum.chi2 == 12.0);
  CHECK(sum.log_likelihood == -3.0);
  CHECK(sum.calc_misfit() == 1.5);
  CHECK(HoldOutSum({a}).calc_misfit() == 1.0);
  b.failure = "lost contact";
  CHECK_FALSE(HoldOutSum({a, b}).is_whole);
}

TEST_CASE("A force map removes a tenth of the excess over noise, or is not taken", "[unit]") {
  const HoldOutSum now = make_sum(1500.0, -900.0);
  // The odds are those of e^100: only the fraction decides.
  CHECK_FALSE(is_map_confirmed(now, make_sum(1451.0, -700.0), {}));
  CHECK(is_map_confirmed(now, make_sum(1449.0, -700.0), {}));
  CHECK(calc_removed_share(now, make_sum(1400.0, 0.0)) == Approx(0.2));
  CHECK(calc_removed_share(now, make_sum(900.0, 0.0)) == 1.0);
}

TEST_CASE("Held-out runs favor a force map by log odds of 3, each reading by its misfit",
          "[unit]") {
  const HoldOutSum now = make_sum(3000.0, -900.0);
  // Misfit 2: a difference of 6.
  CHECK_FALSE(is_map_confirmed(now, make_sum(2000.0, -894.1), {}));
  CHECK(is_map_confirmed(now, make_sum(2000.0, -893.9), {}));
  HoldOutSum failed = make_sum(1000.0, 0.0);
  failed.is_whole = false;
  CHECK_FALSE(is_map_confirmed(now, failed, {}));
}

TEST_CASE("A force map replaces causes that explain at most half of what it does", "[unit]") {
  const HoldOutSum before = make_sum(3000.0, 0.0), map = make_sum(1000.0, 0.0);
  CHECK(explains_causes(before, make_sum(2010.0, 0.0), map, {}));
  CHECK_FALSE(explains_causes(before, make_sum(1990.0, 0.0), map, {}));
}

/// The factor on a force that is the same everywhere.
Unknown make_constant_part(double force) {
  ForceMap map;
  map.coefficients = {force};
  return make_map_unknown("part", std::make_shared<const ForceMap>(map), {0.0, 1.0});
}

TEST_CASE("The standard error of a force map is that of its correlated parts, with the misfit",
          "[unit]") {
  WhitenedFit fit;
  fit.fit.unknowns = {Unknown{}, make_constant_part(2.0), make_constant_part(-1.0)};
  fit.fit.uncertainty.covariance = Eigen::MatrixXd::Identity(3, 3);
  fit.fit.widened.covariance.resize(3, 3);
  fit.fit.widened.covariance << 50.0, 5.0, 5.0, 5.0, 4.0, 1.0, 5.0, 1.0, 9.0;
  // (2, -1) ((4, 1), (1, 9)) (2, -1)'
  CHECK(calc_map_sigma(fit, 0.01, 0.2) ==
        Approx(std::sqrt(16.0 - 4.0 + 9.0)).epsilon(tolerance(1e-12)));
}

}  // namespace
}  // namespace strut
