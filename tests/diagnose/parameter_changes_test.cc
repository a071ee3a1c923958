// Reported intervals of the model's own parameters, worked out by hand.
#include "diagnose/decide/parameter_changes.h"

#include <catch2/catch.hpp>

#include "tests/support/strut_stand.h"
#include "tests/support/tolerance.h"

namespace strut {
namespace {

using test::tolerance;

/// A fit of the damping; its residual widens the standard error fourfold.
WhitenedFit make_fit(const CampaignData& data, double value, double sigma) {
  WhitenedFit fit;
  fit.shared_count = 1;
  fit.fit.unknowns = {make_shared_unknown(data.runs, "damping")};
  fit.fit.values = {value};
  fit.fit.at_bound = {false};
  fit.fit.uncertainty.sigma = {sigma};
  fit.fit.widened.sigma = {4.0 * sigma};
  return fit;
}

Candidate make_candidate(const std::string& effect, double damping) {
  Candidate c;
  c.hypothesis.effect = effect;
  c.base_values = {damping};
  return c;
}

struct Changed {
  CampaignData data = test::make_stand({{0.01, 1.0}});
  Selection selection;
  CausePosition position;

  /// Two members of a group that differ in the damping by `shift`.
  explicit Changed(double shift) {
    selection.base = make_fit(data, 1100.0, 5.0);
    selection.extended = make_fit(data, 1050.0, 2.5);
    selection.extended.fit.at_bound = {true};
    selection.rounds.resize(1);
    selection.rounds[0].candidates = {make_candidate("a", 1040.0),
                                      make_candidate("b", 1040.0 + shift)};
    selection.round_of = {0};
    position.candidates = {{"a", "", 0.5, 9.0, {}}, {"b", "", 0.5, 9.0, {}}};
    position.close = 2;
  }
  ParameterChange get() const {
    return list_parameter_changes(data, selection, {position}).front();
  }
};

TEST_CASE(
    "The interval of a parameter is 1.96 standard errors, widened by the misfit, to each side",
    "[unit]") {
  const Changed changed(0.0);
  const ParameterChange c = changed.get();
  CHECK(c.name == "damping");
  CHECK(c.nominal == test::kStandDamping);
  CHECK(c.before == 1100.0);
  CHECK(c.before_low == Approx(1100.0 - 39.1993).margin(tolerance(1e-3)));
  CHECK(c.before_high == Approx(1100.0 + 39.1993).margin(tolerance(1e-3)));
  CHECK(c.after == 1050.0);
  CHECK(c.after_low == Approx(1050.0 - 19.5996).margin(tolerance(1e-3)));
  CHECK(c.after_high == Approx(1050.0 + 19.5996).margin(tolerance(1e-3)));
  CHECK_FALSE(c.before_at_bound);
  CHECK(c.after_at_bound);
  CHECK_FALSE(c.differs);
}

TEST_CASE("A parameter differs between members whose interval is 1.5 times that of one", "[unit]") {
  CHECK_FALSE(Changed(19.0).get().differs);  // 39.2 + 19 against 58.8
  const ParameterChange c = Changed(20.0).get();
  CHECK(c.differs);
  CHECK(c.after_high == Approx(1050.0 + 20.0 + 19.5996).margin(tolerance(1e-3)));
  CHECK(c.after_low == Approx(1050.0 - 19.5996).margin(tolerance(1e-3)));
}

}  // namespace
}  // namespace strut
