// Log odds of candidates against their formula, worked out by hand.
#include "diagnose/decide/probability.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/tolerance.h"

namespace strut {
namespace {

using test::tolerance;

/// `alias`: number of the class.
Candidate make_candidate(double gain, std::size_t alias) {
  Candidate c;
  c.hypothesis.place = "front";
  c.hypothesis.parameters = {{"a", "a", true}};
  c.gain = gain;
  c.alias = alias;
  return c;
}

/// Log odds of the second candidate relative to the first.
double calc_odds(const Candidate& first, const Candidate& second, double misfit) {
  SelectRound round;
  round.candidates = {first, second};
  round.misfit = misfit;
  const std::vector<double> odds = calc_log_odds(round);
  return odds[1] - odds[0];
}

TEST_CASE("Log odds are half the difference of chi2 over misfit and temperature", "[unit]") {
  // 400 / 2 and 390 / 2; the temperature is 1 + 0.004 * 200.
  CHECK(calc_odds(make_candidate(400.0, 0), make_candidate(390.0, 1), 2.0) ==
        Approx(-0.5 * 5.0 / 1.8).epsilon(tolerance(1e-12)));
  // A small effect is hardly blurred.
  CHECK(calc_odds(make_candidate(10.0, 0), make_candidate(4.0, 1), 1.0) ==
        Approx(-3.0 / 1.04).epsilon(tolerance(1e-12)));
}

TEST_CASE("A free shape and a single corner cost one unit of log odds each", "[unit]") {
  const Candidate plain = make_candidate(50.0, 0);
  Candidate shaped = make_candidate(50.0, 1), corner = make_candidate(50.0, 1);
  shaped.hypothesis.parameters.push_back({"s", "s", false});
  shaped.hypothesis.parameters.push_back({"t", "t", false});
  corner.hypothesis.place = "front_left";
  CHECK(calc_odds(plain, shaped, 1.0) == Approx(-2.0).epsilon(tolerance(1e-12)));
  CHECK(calc_odds(plain, corner, 1.0) == Approx(-1.0).epsilon(tolerance(1e-12)));
  // Also where the cheaper one comes second.
  CHECK(calc_odds(corner, plain, 1.0) == Approx(1.0).epsilon(tolerance(1e-12)));
}

TEST_CASE("Names of one class share its probability", "[unit]") {
  SelectRound round;
  round.candidates = {make_candidate(50.0, 0), make_candidate(50.0, 1), make_candidate(50.0, 1),
                      make_candidate(50.0, 1)};
  const std::vector<double> odds = calc_log_odds(round);
  CHECK(odds[0] == 0.0);
  for (std::size_t i = 1; i < 4; ++i) {
    CHECK(odds[i] == Approx(-std::log(3.0)).epsilon(tolerance(1e-12)));
  }
}

}  // namespace
}  // namespace strut
