// What the members of a group share, in closed form.
#include "diagnose/decide/shared_law.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tests/support/strut_stand.h"
#include "tests/support/tolerance.h"

namespace strut {
namespace {

using test::tolerance;

TEST_CASE("The secants of a law are its slopes by least squares", "[unit]") {
  // A harmonic motion v = V cos, with Coulomb friction F0: c + 4 F0 / (pi V).
  std::vector<double> d, v, f;
  const double speed = 0.5, friction = 3.0;
  constexpr int kCount = 100000;
  for (int i = 0; i < kCount; ++i) {
    const double phase = 2.0 * std::numbers::pi * (i + 0.5) / kCount;
    d.push_back(0.02 * std::sin(phase));
    v.push_back(speed * std::cos(phase));
    f.push_back(7.0 + 900.0 * d.back() + 8.0 * v.back() + std::copysign(friction, v.back()));
  }
  const Slopes slopes = fit_slopes(d, v, f);
  CHECK(slopes.stiffness == Approx(900.0).epsilon(tolerance(1e-6)));
  CHECK(slopes.damping ==
        Approx(8.0 + 4.0 * friction / (std::numbers::pi * speed)).epsilon(tolerance(1e-4)));
}

Candidate make_candidate(const std::string& effect, double damping) {
  Candidate c;
  c.hypothesis.effect = effect;
  c.base_values = {damping};
  return c;
}

TEST_CASE("The interval of a parameter contains that of every member of a group", "[unit]") {
  Selection s;
  s.base.shared_count = s.extended.shared_count = 1;
  s.extended.fit.values = {10.2};
  s.extended.fit.widened.sigma = {0.1};
  s.rounds.resize(1);
  s.rounds[0].candidates = {make_candidate("a", 10.0), make_candidate("b", 30.5)};
  s.round_of = {0};
  CausePosition position;
  position.candidates = {{"a", "", 0.5, 9.0, {}}, {"b", "", 0.5, 9.0, {}}};
  position.close = 1;
  GroupValue alone = list_group_values(s, {position}).front();
  CHECK(alone.high == Approx(10.2 + 0.195996).epsilon(tolerance(1e-6)));
  position.close = 2;
  const GroupValue both = list_group_values(s, {position}).front();
  CHECK(both.value == 10.2);
  CHECK(both.low == alone.low);
  // The extended model's, and the difference between the members in their own round.
  CHECK(both.high == Approx(10.2 + 20.5 + 0.195996).epsilon(tolerance(1e-6)));
}

TEST_CASE("The interval of a secant is that of the calibrated model's parameter, over the group",
          "[unit]") {
  CampaignData data = test::make_stand({{0.01, 1.0}});
  // The delay of a motion sensor must not change the strut's secants.
  data.runs[0].setup.effects() = {{"sensor_delay", "displacement", {0.02}}};
  const Unknown damping = make_shared_unknown(data.runs, "damping");
  Selection s;
  s.base.shared_count = s.extended.shared_count = 1;
  s.base.runs = {0};
  s.base.fit.unknowns = s.extended.fit.unknowns = {damping};
  s.base.fit.values = {1030.0};
  s.extended.fit.values = {1000.0};
  s.base.fit.uncertainty.sigma = {1.0};
  s.base.fit.widened.sigma = {3.0};
  s.rounds.resize(1);
  s.rounds[0].candidates = {make_candidate("a", 0.0), make_candidate("b", 0.0)};
  s.rounds[0].candidates[0].shared = {{damping}, {990.0}};
  s.rounds[0].candidates[1].shared = {{damping}, {1030.0}};
  s.round_of = {0};
  CausePosition position;
  position.candidates = {{"a", "", 0.5, 9.0, {}}, {"b", "", 0.5, 9.0, {}}};
  position.close = 2;
  const std::vector<StrutSecant> secants = list_secants(data, s, {position});
  REQUIRE(secants.size() == 1);
  const GroupValue& found = secants.front().damping;
  // The spline through 200 points a period errs by 1e-6, its ends by more.
  CHECK(found.value == Approx(1000.0).margin(tolerance(0.01)));
  CHECK(found.low == Approx(1000.0 - 5.8799).margin(tolerance(0.02)));
  CHECK(found.high == Approx(1000.0 + 40.0 + 5.8799).margin(tolerance(0.02)));
  // This stand's strut has no spring. What is not fitted has no error.
  CHECK(std::isnan(secants.front().stiffness.value));
  data.runs[0].setup.rig().rig.stiffness = 5000.0;
  const GroupValue stiffness = list_secants(data, s, {position}).front().stiffness;
  CHECK(stiffness.value == Approx(5000.0).epsilon(tolerance(1e-3)));
  CHECK(stiffness.high - stiffness.low < tolerance(0.01));
}

}  // namespace
}  // namespace strut
