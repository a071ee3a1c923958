// Reported intervals of the model's own parameters, worked out by hand.
#include "diagnose/decide/parameter_changes.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

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
  Diagnosis diagnosis;
  Selection& selection = diagnosis.selection;

  /// Two members of a group that differ in the damping by `shift`.
  explicit Changed(double shift) {
    selection.base = make_fit(data, 1100.0, 5.0);
    selection.extended = make_fit(data, 1050.0, 2.5);
    selection.extended.fit.at_bound = {true};
    selection.rounds.resize(1);
    selection.rounds[0].candidates = {make_candidate("a", 1040.0),
                                      make_candidate("b", 1040.0 + shift)};
    selection.round_of = {0};
    CausePosition position;
    position.candidates = {{"a", "", 0.5, 9.0, {}}, {"b", "", 0.5, 9.0, {}}};
    position.close = 2;
    diagnosis.verdict.positions = {position};
  }
  ParameterChange get() const { return list_parameter_changes(data, diagnosis).front(); }
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

TEST_CASE("The final model's interval allows for undetected effects, beside the group's",
          "[unit]") {
  Changed changed(20.0);
  // An effect at 3 sigma that would raise the damping by 6 of its standard errors (10 each).
  changed.selection.undetected = {{1.0, 3.0, true, {20.0}}};
  const Interval open = calc_averaged_interval(1050.0, 10.0, 0, changed.selection.undetected);
  const ParameterChange c = changed.get();
  REQUIRE(open.high > 1050.0 + 30.0);
  CHECK(c.after_high == Approx(open.high + 20.0).margin(tolerance(1e-6)));
  CHECK(c.after_low == Approx(open.low).margin(tolerance(1e-6)));
  CHECK(c.before_high == Approx(1100.0 + 39.1993).margin(tolerance(1e-3)));
}

TEST_CASE("Without an extension the calibrated model is the final one", "[unit]") {
  Changed changed(0.0);
  changed.diagnosis.verdict.positions.clear();
  changed.selection.extended = changed.selection.base;
  changed.selection.undetected = {{1.0, 3.0, true, {40.0}}};
  const ParameterChange c = changed.get();
  CHECK(c.after_high > 1100.0 + 60.0);
  CHECK(c.before_high == c.after_high);
  CHECK(c.before_low == c.after_low);
}

TEST_CASE("A residual of unknown form widens the interval by its energy", "[unit]") {
  Changed changed(0.0);
  FitResult& fit = changed.selection.extended.fit;
  fit.uncertainty.covariance = Eigen::MatrixXd::Constant(1, 1, 2.5 * 2.5);
  changed.selection.left.energy = 4.0;
  const double before = changed.get().after_high;
  changed.selection.is_left = true;
  const ParameterChange c = changed.get();
  // 8 * sqrt(4) * 2.5 = 40 beside the misfit's 10
  CHECK(before == Approx(1050.0 + 19.5996).margin(tolerance(1e-3)));
  CHECK(c.after_high == Approx(1050.0 + 1.95996 * std::hypot(10.0, 40.0)).margin(tolerance(1e-3)));
  CHECK(c.after_low == Approx(1050.0 - 1.95996 * std::hypot(10.0, 40.0)).margin(tolerance(1e-3)));
}

TEST_CASE("A parameter of which the readings say nothing has an infinite interval", "[unit]") {
  Changed changed(0.0);
  changed.selection.extended.fit.widened.sigma = {std::numeric_limits<double>::infinity()};
  changed.selection.undetected = {{1.0, 3.0, true, {20.0}}};
  const ParameterChange c = changed.get();
  CHECK(c.after_low == -std::numeric_limits<double>::infinity());
  CHECK(c.after_high == std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace strut
