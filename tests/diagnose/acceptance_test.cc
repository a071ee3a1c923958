// The rules that make a candidate a cause, each on both sides of its limit.
#include "diagnose/decide/acceptance.h"

#include <catch2/catch.hpp>
#include <cmath>

namespace strut {
namespace {

/// A round whose best candidate is alone; threshold and misfit make 30 of delta chi2 large, and 90
/// certain.
SelectRound make_round(double gain, double stability = 1.0) {
  SelectRound round;
  Candidate c;
  c.gain = gain;
  c.stability = stability;
  round.candidates = {c};
  round.threshold = 20.0;
  round.misfit = 1.5;
  return round;
}

HoldOutRun make_held_out(double chi2) {
  HoldOutRun run;
  run.chi2 = chi2;
  run.expected = 500.0;
  return run;
}

/// A fit of 1000 degrees of freedom, with a held-out run of 500 readings.
Selection make_selection() {
  Selection s;
  s.extended.fit.chi2 = 1200.0;
  s.extended.fit.degrees = 1000;
  s.hold_out_after = {make_held_out(700.0)};
  return s;
}

Selection make_selection_with_cause(double first_gain) {
  Selection s = make_selection();
  s.causes.resize(1);
  s.rounds = {make_round(first_gain)};
  return s;
}

bool is_large(const Selection& selection, const SelectRound& round) {
  return is_large(selection, round, SelectOptions{});
}

TEST_CASE("A candidate is large from the threshold times the misfit on", "[unit]") {
  const Selection s = make_selection();
  CHECK_FALSE(is_large(s, make_round(29.9)));
  CHECK(is_large(s, make_round(30.1)));
  CHECK_FALSE(is_large(s, SelectRound{}));
}

TEST_CASE("A candidate has to be among the best without each of half of the runs, or certain",
          "[unit]") {
  const Selection s = make_selection();
  CHECK_FALSE(is_large(s, make_round(60.0, 0.49)));
  CHECK(is_unstable(make_round(60.0, 0.49), SelectOptions{}));
  CHECK(is_large(s, make_round(60.0, 0.51)));
  CHECK_FALSE(is_unstable(make_round(60.0, 0.51), SelectOptions{}));
  CHECK_FALSE(is_large(s, make_round(89.9, 0.0)));
  CHECK(is_large(s, make_round(90.1, 0.0)));
  CHECK_FALSE(is_unstable(make_round(29.9, 0.0), SelectOptions{}));
}

TEST_CASE("A second cause explains a tenth of the first, or 3.5 % of it with certainty", "[unit]") {
  CHECK_FALSE(is_large(make_selection_with_cause(510.0), make_round(50.0)));
  CHECK(is_large(make_selection_with_cause(490.0), make_round(50.0)));
  CHECK_FALSE(is_large(make_selection_with_cause(5750.0), make_round(200.0)));
  CHECK(is_large(make_selection_with_cause(5700.0), make_round(200.0)));
}

TEST_CASE("Where the model's error dominates, a cause removes 15 % of it, a pair twice that",
          "[unit]") {
  Selection s = make_selection();
  s.extended.is_dominated = true;
  s.extended.fit.chi2 = 1e5;
  CHECK_FALSE(is_large(s, make_round(14900.0)));
  CHECK(is_large(s, make_round(15100.0)));
  SelectRound pair = make_round(5000.0);
  pair.pair_gain = 29900.0;
  CHECK_FALSE(is_large(s, pair));
  pair.pair_gain = 30100.0;
  CHECK(is_large(s, pair));
}

/// The held-out run of make_selection() with residuals that lower its chi2 by `fall` and differ
/// from it by the sum of squares `expected`.
std::vector<HoldOutRun> make_judged(Selection& selection, double fall, double expected) {
  Eigen::Vector2d before(25.0, 0.0), change(-0.5 * (fall + expected) / 25.0, 0.0);
  change(1) = std::sqrt(expected - change(0) * change(0));
  const auto make = [](const Eigen::Vector2d& residual) {
    HoldOutRun run = make_held_out(residual.squaredNorm());
    run.residual = residual;
    return run;
  };
  selection.hold_out_after = {make(before)};
  return {make(before + change)};
}

bool is_confirmed_by(double fall, double expected, double gain = 1e3, bool is_dominated = false) {
  Selection s = make_selection();
  s.extended.is_dominated = is_dominated;
  const std::vector<HoldOutRun> judged = make_judged(s, fall, expected);
  return is_confirmed(s, make_round(gain), judged, SelectOptions{});
}

TEST_CASE("Held-out runs contradict a cause that makes them worse by more than noise", "[unit]") {
  // True, a cause lowers chi2 by s with the standard deviation 2 sqrt(s): -8 is three of them off.
  const auto is_possible = [](double fall, double expected, double misfit) {
    return HoldOutFall{fall, expected, misfit}.is_possible();
  };
  CHECK(is_possible(-7.9, 4.0, 1.0));
  CHECK_FALSE(is_possible(-8.1, 4.0, 1.0));
  CHECK(is_possible(-19.9, 4.0, 4.0));  // of noise that is twice as large
  CHECK_FALSE(is_possible(-20.1, 4.0, 4.0));
  // The largest rise that noise explains is 9, and runs that respond must not become worse.
  CHECK(is_possible(-8.9, 9.0, 1.0));
  CHECK_FALSE(is_possible(-9.1, 9.0, 1.0));
  // A round's misfit of 1.5 makes that 13.5, at s = 13.5.
  CHECK(is_confirmed_by(-13.4, 13.5));
  CHECK_FALSE(is_confirmed_by(-13.6, 13.5));
  CHECK(is_confirmed_by(0.1, 60.0));
  CHECK_FALSE(is_confirmed_by(-0.1, 60.0));
  // Without any response they do not decide.
  CHECK(is_possible(0.0, 0.0, 1.0));
}

TEST_CASE("Where the model's error dominates, half of its fraction has to leave the held-out runs",
          "[unit]") {
  // 0.5 * 0.15 * 625
  CHECK_FALSE(is_confirmed_by(46.0, 60.0, 1e3, true));
  CHECK(is_confirmed_by(47.0, 60.0, 1e3, true));
}

TEST_CASE("A cause exceeds the threshold over all runs, held-out ones included", "[unit]") {
  CHECK(is_confirmed_by(-3.9, 4.0, 34.0));
  CHECK_FALSE(is_confirmed_by(-4.1, 4.0, 34.0));
}

TEST_CASE("A held-out run that cannot be simulated confirms nothing", "[unit]") {
  const Selection s = make_selection();
  HoldOutRun failed;
  failed.failure = "lost contact";
  CHECK(sum_chi2({make_held_out(3.0), make_held_out(4.0)}) == 7.0);
  CHECK(sum_chi2({make_held_out(3.0), failed}) > 1e200);
  CHECK(is_contradicted(s, make_round(1e6), {failed}));
  // One that could not be simulated before says nothing, but confirms nothing either.
  Selection before = s;
  before.hold_out_after = {failed};
  CHECK_FALSE(is_contradicted(before, make_round(1e6), {failed}));
  CHECK_FALSE(is_confirmed(before, make_round(1e6), {failed}, SelectOptions{}));
  CHECK_FALSE(is_confirmed(s, make_round(1e6), {failed}, SelectOptions{}));
}

TEST_CASE("A rejected candidate of twice the threshold is residual of the causes", "[unit]") {
  const Selection s = make_selection_with_cause(1e5);
  CHECK(find_rejected(s, make_round(59.9)).gain == 0.0);
  CHECK(find_rejected(s, make_round(60.1)).gain == 60.1);
  // No cause whose form it would be.
  CHECK(find_rejected(make_selection(), make_round(60.1)).gain == 0.0);
  SelectRound accepted = make_round(60.1);
  accepted.accepted = true;
  CHECK(find_rejected(s, accepted).gain == 0.0);
}

TEST_CASE("A candidate that was refused leaves a residual, whatever its size", "[unit]") {
  SelectRound round = make_round(30.1);
  CHECK(find_rejected(make_selection(), round).gain == 0.0);
  round.refusal = Refusal::kContradicted;
  CHECK(find_rejected(make_selection(), round).gain == 30.1);
  CHECK(find_rejected(make_selection_with_cause(1e5), round).gain == 30.1);
  CHECK(find_rejected(make_selection(), round).reason == Refusal::kContradicted);
}

TEST_CASE("A fit with values that its effect cannot have shows that something is there", "[unit]") {
  SelectRound round = make_round(20.0);
  round.refused_gain = 59.9;
  CHECK(find_rejected(make_selection(), round).gain == 0.0);
  round.refused_gain = 60.1;
  CHECK(find_rejected(make_selection(), round).gain == 60.1);
  CHECK(find_rejected(make_selection_with_cause(1e5), round).gain == 60.1);
  CHECK(find_rejected(make_selection_with_cause(1e5), round).reason == Refusal::kImplausible);
  round.candidates.clear();
  CHECK(find_rejected(make_selection(), round).gain == 60.1);
  round.misfit = 1.51;
  CHECK(find_rejected(make_selection(), round).gain == 0.0);
}

TEST_CASE("A calibration may miss its minimum by a twentieth of what the causes take", "[unit]") {
  FitResult calibration;
  calibration.chi2 = 4000.0;
  calibration.degrees = 1000;
  calibration.distance = 3.0;  // 9 of chi2 in units of its mean, 4
  CHECK_FALSE(is_near_minimum(calibration, {500.0, 219.0}));
  CHECK(is_near_minimum(calibration, {500.0, 221.0}));
  CHECK_FALSE(is_near_minimum(calibration, {}));
  // A chi2 below its expectation makes no distance smaller.
  calibration.chi2 = 500.0;
  CHECK_FALSE(is_near_minimum(calibration, {179.0}));
  CHECK(is_near_minimum(calibration, {181.0}));
}

TEST_CASE("Another candidate leads a round if its pair gains 2 %, and the threshold, more",
          "[unit]") {
  CHECK(choose_lead({1000.0, 0.0, 1029.0}, 30.0) == 0);
  CHECK(choose_lead({1000.0, 0.0, 1031.0}, 30.0) == 2);
  CHECK(choose_lead({10000.0, 10190.0}, 30.0) == 0);
  CHECK(choose_lead({10000.0, 10210.0}, 30.0) == 1);
  CHECK(choose_lead({10000.0, 11000.0, 10500.0}, 30.0) == 1);
  CHECK(choose_lead({10000.0, 9000.0}, 30.0) == 0);
}

TEST_CASE("A misfit is chi2 of the best fit per degree of freedom, and never below 1", "[unit]") {
  FitResult fit;
  fit.chi2 = 700.0;
  fit.degrees = 200;
  CHECK(calc_misfit(fit, 100.0) == 3.0);
  CHECK(calc_misfit(fit, 600.0) == 1.0);
}

TEST_CASE("An effect of the model's file is dispensable within three standard deviations",
          "[unit]") {
  FitResult now;
  now.chi2 = 900.0;
  now.degrees = 200;
  // With other values of the effect 500 are left: 2.5 per degree of freedom, so 22.5 for 3 sigmas.
  CHECK(is_dispensable(now, 400.0, 377.6));
  CHECK_FALSE(is_dispensable(now, 400.0, 377.4));
  CHECK(is_dispensable(now, 400.0, 410.0));
  // Residuals below their noise count as noise.
  CHECK(is_dispensable(now, 800.0, 791.1));
  CHECK_FALSE(is_dispensable(now, 800.0, 790.9));
}

}  // namespace
}  // namespace strut
