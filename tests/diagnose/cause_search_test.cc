// The search for causes on recordings of known laws: fits of one effect, effects of the model file,
// and laws in series, of which the best single effect is none.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <string>

#include "diagnose/decide/select.h"
#include "tests/support/campaign_files.h"
#include "tests/support/tolerance.h"
#include "tests/support/whitened_baseline.h"

namespace strut {
namespace {

using test::QuarterTruth;
using test::TemporaryFolder;
using test::tolerance;

constexpr double kFriction = 120.0;  // N

/// A corner of a car: 400 kg on 20 kN/m, with dry friction.
QuarterTruth make_corner() {
  QuarterTruth truth;
  truth.sprung_mass = 400.0;
  truth.unsprung_mass = 40.0;
  truth.stiffness = 2e4;
  truth.damping = 1300.0;
  truth.tire_stiffness = 2e5;
  truth.tire_damping = 100.0;
  truth.friction = kFriction;
  truth.noise = 2e-4;
  truth.amplitude = 0.03;
  return truth;
}

CampaignData read_corner(const TemporaryFolder& folder, const QuarterTruth& truth,
                         const std::string& effect = "", const std::string& road = "") {
  test::write_record(folder, "a.csv", test::record_quarter_car(truth));
  QuarterTruth second = truth;
  second.amplitude *= 0.7;
  second.seed += 1;
  test::write_record(folder, "b.csv", test::record_quarter_car(second));
  folder.write("corner.toml",
               "type = \"quarter_car\"\nsprung_mass = 400\nunsprung_mass = 40\n"
               "stiffness = 21000\ndamping = 1500\ntire_stiffness = 200000\ntire_damping = 100\n"
               "tire_contact = \"bilateral\"\ngravity = 9.81\n" +
                   effect);
  test::CampaignText text;
  text.model = "corner.toml";
  text.unsprung = "{ column = \"unsprung\", noise = 2e-4 }";
  text.sprung = "{ column = \"sprung\", noise = 2e-4 }";
  text.fit = "free = [\"stiffness\", \"damping\", \"tire_stiffness\"]\n";
  if (!road.empty()) text.road = road;
  return read_campaign_data(test::write_campaign(folder, text));
}

const Hypothesis& find_hypothesis(const std::vector<Hypothesis>& list, const std::string& effect) {
  const auto found = std::find_if(list.begin(), list.end(),
                                  [&](const Hypothesis& h) { return h.effect == effect; });
  REQUIRE(found != list.end());
  return *found;
}

std::vector<Hypothesis> list_all(const CampaignData& data, const WhitenedFit& fit) {
  return list_hypotheses(data, fit.shared());
}

/// A corner with friction, and its fit without.
struct FrictionSearch {
  TemporaryFolder folder;
  CampaignData data = read_corner(folder, make_corner());
  WhitenedFit base = test::fit_whitened_baseline(data);
  TestBench bench{data, base, 1};
  Hypothesis friction = find_hypothesis(list_all(data, base), "strut_friction");
};

TEST_CASE("The fit of an effect converges from far starts, or says that it has not", "[unit]") {
  const FrictionSearch search;
  for (const double force : {3.0, 40.0, 1500.0}) {
    INFO(force);
    const HypothesisFit fit = search.bench.fit(search.friction, {force, 0.03, 0.0});
    REQUIRE(fit.failure.empty());
    CHECK(fit.converged);
    CHECK(fit.distance <= 0.1);
    const double found = fit.values[search.base.fit.unknowns.size()];
    // The law is the catalogue's: four standard errors, of 1 N with the sensors' tolerances.
    CHECK(std::abs(found - kFriction) < tolerance(4.0 * fit.sigma[0]));
    CHECK(fit.sigma[0] < 1.5);
  }
  const HypothesisFit one_step = search.bench.fit(search.friction, {3.0, 0.03, 0.0}, {1, 0.1});
  CHECK_FALSE(one_step.converged);
  CHECK(one_step.distance > 0.1);
}

TEST_CASE("A fit that goes on from values ends where one search does", "[unit]") {
  const FrictionSearch search;
  const std::vector<double> start = {40.0, 0.02, 0.0};
  const HypothesisFit whole = search.bench.fit(search.friction, start);
  const HypothesisFit first = search.bench.fit(search.friction, start, {2, 0.1});
  const HypothesisFit rest = search.bench.fit(search.friction, start, {60, 0.1}, first.values);
  CHECK(first.gain < whole.gain);
  CHECK(rest.converged);
  // Both within a tenth of a standard error of the minimum, where chi2 is 0.01 above it.
  CHECK(std::abs(rest.gain - whole.gain) < tolerance(0.05));
}

TEST_CASE("An effect of the model file that the rig lacks is found, and removed", "[unit]") {
  QuarterTruth truth = make_corner();
  truth.friction = 0.0;
  const TemporaryFolder folder;
  const CampaignData data =
      read_corner(folder, truth, "[[effect]]\nname = \"damper_asymmetry\"\nasymmetry = 0.3\n");
  const Selection selection = select_causes(data, {});
  REQUIRE(selection.causes.size() == 1);
  const Hypothesis& cause = selection.causes[0];
  CHECK(cause.effect == "damper_asymmetry");
  CHECK(cause.change == EffectChange::kRemoved);
  CHECK(cause.describe() == "without damper_asymmetry");
  CHECK(selection.extended.fit.is_adequate());
  CHECK(list_effects_on(data, selection.base.shared()).size() == 1);
  const SharedValues shared = selection.extended.shared();
  CHECK(std::abs(shared.values.back()) < tolerance(1e-6));
}

TEST_CASE("An effect of the model file with a wrong size is changed, not removed", "[unit]") {
  const TemporaryFolder folder;
  const CampaignData data = read_corner(
      folder, make_corner(), "[[effect]]\nname = \"strut_friction\"\nforce = 60\nspeed = 0.01\n");
  const Selection selection = select_causes(data, {});
  REQUIRE(selection.causes.size() == 1);
  const Hypothesis& cause = selection.causes[0];
  CHECK(cause.effect == "strut_friction");
  CHECK(cause.change == EffectChange::kChanged);
  CHECK(cause.describe() == "another strut_friction");
  const FitResult& fit = selection.extended.fit;
  const auto force = std::find_if(fit.unknowns.begin(), fit.unknowns.end(), [](const Unknown& u) {
    return u.name == "strut_friction_force";
  });
  REQUIRE(force != fit.unknowns.end());
  CHECK(fit.values[static_cast<std::size_t>(force - fit.unknowns.begin())] ==
        Approx(kFriction).margin(tolerance(4.0)));
}

TEST_CASE("A late recorder is one cause, not one for every sensor", "[unit]") {
  constexpr double kLate = 0.004;  // s
  QuarterTruth truth = make_corner();
  truth.friction = 0.0;
  const TemporaryFolder folder;
  // The road's column is taken to be late, so that all channels are.
  const CampaignData data =
      read_corner(folder, truth, "", "{ column = \"road\", role = \"input\", delay = 0.004 }");
  const Selection selection = select_causes(data, {});
  REQUIRE(selection.causes.size() == 1);
  CHECK(selection.causes[0].effect == "clock_offset");
  const FitResult& fit = selection.extended.fit;
  const std::size_t at = selection.extended.shared_count - 1;
  REQUIRE(fit.unknowns[at].name == "clock_offset");
  CHECK(std::abs(fit.values[at] - kLate) < tolerance(4.0 * fit.widened.sigma[at]));
  CHECK(fit.widened.sigma[at] < 2e-4);
}

/// A damper on a crank that is stiffer in rebound than in compression by the fraction 2
/// `asymmetry`.
std::string record_damper(double amplitude, double asymmetry, std::uint64_t seed) {
  constexpr double kRate = 200.0, kDuration = 4.0, kFrequency = 1.5, kDamping = 1000.0;
  const double omega = 2.0 * std::numbers::pi * kFrequency;
  std::string text = "t,x,F\n";
  for (int i = 0; i <= static_cast<int>(kDuration * kRate); ++i) {
    const double t = i / kRate, v = amplitude * omega * std::cos(omega * t);
    const double force = kDamping * v * (v > 0.0 ? 1.0 - asymmetry : 1.0 + asymmetry);
    const double noise = test::calc_test_normal(seed, 0, static_cast<std::uint64_t>(i));
    text += test::print_number(t) + "," + test::print_number(amplitude * std::sin(omega * t)) +
            "," + test::print_number(force + noise) + "\n";
  }
  return text;
}

/// A strut rig's campaign of two runs for fitting and one that is held out. `noise`: more keys of
/// the force's column.
CampaignData read_three_runs(const TemporaryFolder& folder, const std::vector<std::string>& records,
                             const std::string& noise, const std::string& free) {
  folder.write("a.csv", records[0]);
  folder.write("b.csv", records[1]);
  folder.write("c.csv", records[2]);
  folder.write("rig.toml", "type = \"strut_rig\"\nstiffness = 0\ndamping = 1000\n");
  return read_campaign_data(
      folder.write("campaign.toml",
                   "model = \"rig.toml\"\n[columns]\ntime = { column = \"t\" }\n"
                   "displacement = { column = \"x\" }\nforce = { column = \"F\"" +
                       noise + " }\n[fit]\nfree = [" + free +
                       "]\n[[run]]\nfile = \"a.csv\"\nuse = \"fit\"\n"
                       "[[run]]\nfile = \"b.csv\"\nuse = \"fit\"\n[[run]]\nfile = \"c.csv\"\nuse = "
                       "\"hold_out\"\n"));
}

/// Two runs for fitting and one that is held out, each with its own asymmetry.
Selection diagnose_dampers(double first, double second, double held_out,
                           const SelectOptions& options = {}) {
  const TemporaryFolder folder;
  const CampaignData data =
      read_three_runs(folder,
                      {record_damper(0.02, first, 1), record_damper(0.015, second, 2),
                       record_damper(0.0175, held_out, 3)},
                      ", noise = 1.0", "\"damping\"");
  return select_causes(data, options);
}

TEST_CASE("An effect that the held-out run contradicts is unknown, not absent", "[unit]") {
  constexpr double kSmall = 0.004;  // 10 sigma over the two runs
  const Selection right = diagnose_dampers(kSmall, kSmall, kSmall);
  REQUIRE(right.causes.size() == 1);
  CHECK(right.causes.front().effect == "damper_asymmetry");
  CHECK(right.refusal == Refusal::kNone);
  const Selection opposite = diagnose_dampers(kSmall, kSmall, -kSmall);
  CHECK(opposite.causes.empty());
  CHECK(opposite.refusal == Refusal::kContradicted);
  CHECK(opposite.refused == "damper_asymmetry");
  CHECK(opposite.is_left);
  CHECK(opposite.left.energy > 20.0);
}

TEST_CASE("An effect that is not stable enough is unknown, not absent", "[unit]") {
  SelectOptions options;
  options.stability = 1.1;  // more than any effect has
  options.certain = 1e9;    // none is exempt
  const Selection unstable = diagnose_dampers(0.004, 0.004, 0.004, options);
  CHECK(unstable.causes.empty());
  CHECK(unstable.refusal == Refusal::kUnstable);
  CHECK(unstable.refused == "damper_asymmetry");
  CHECK(unstable.is_left);
}

TEST_CASE("A right effect of the model file is left alone", "[unit]") {
  const TemporaryFolder folder;
  const CampaignData data = read_corner(
      folder, make_corner(), "[[effect]]\nname = \"strut_friction\"\nforce = 120\nspeed = 0.01\n");
  CHECK(select_causes(data, {}).causes.empty());
}

/// A damper on a crank: friction and damping behind a play, and a force that lags. Integrated by
/// Euler's rule at a fortieth of the sampling interval.
std::string record_series(double amplitude, double frequency, std::uint64_t seed) {
  constexpr double kRate = 250.0, kDuration = 2.5, kPlay = 4e-3, kLag = 4e-3;
  constexpr int kSubsteps = 40;
  const double omega = 2.0 * std::numbers::pi * frequency, h = 1.0 / kRate / kSubsteps;
  double joint = 0.0, force = 0.0;
  std::string text = "t,x,F\n";
  for (int i = 0; i <= static_cast<int>(kDuration * kRate); ++i) {
    const double t = i / kRate;
    const auto place = static_cast<std::uint64_t>(i);
    text += test::print_number(t) + "," + test::print_number(amplitude * std::sin(omega * t)) +
            "," + test::print_number(force + 1.0 * test::calc_test_normal(seed, 0, place)) + "\n";
    for (int k = 0; k < kSubsteps; ++k) {
      const double v = amplitude * omega * std::cos(omega * (t + k * h));
      const bool is_loose = v > 0.0 ? joint < 0.5 * kPlay : joint > -0.5 * kPlay;
      const double law = is_loose ? 0.0 : 400.0 * std::tanh(v / 0.005) + 800.0 * v;
      joint = std::clamp(joint + h * v, -0.5 * kPlay, 0.5 * kPlay);
      force += h / kLag * (law - force);
    }
  }
  return text;
}

CampaignData read_series(const TemporaryFolder& folder, const std::string& free = "\"damping\"") {
  return read_three_runs(
      folder,
      {record_series(0.02, 1.0, 1), record_series(0.01, 2.0, 2), record_series(0.015, 1.5, 3)}, "",
      free);
}

bool has_cause(const Selection& selection, const std::vector<std::string>& effects) {
  return std::any_of(selection.causes.begin(), selection.causes.end(), [&](const Hypothesis& h) {
    return std::find(effects.begin(), effects.end(), h.effect) != effects.end();
  });
}

TEST_CASE("Shapes are looked for where they are what their name says, or as in the file",
          "[unit]") {
  const TemporaryFolder folder;
  const CampaignData data = read_series(folder);
  Hypothesis knee =
      find_hypothesis(list_all(data, test::fit_whitened_baseline(data)), "damper_blow_off");
  REQUIRE(knee.parameters[1].key == "knee");
  const double fastest = 2.0 * std::numbers::pi * 0.02;  // m/s
  CHECK(make_unknowns(data, knee)[1].high == Approx(3.0 * fastest).epsilon(tolerance(0.01)));
  CHECK(make_unknowns(data, knee)[0].high == Approx(0.98));
  knee.reference[1] = 1.0;
  CHECK(make_unknowns(data, knee)[1].high == Approx(1.0));
}

TEST_CASE("A stop that is met at rest is no stop", "[unit]") {
  const TemporaryFolder folder;
  const CampaignData data = read_series(folder);
  Hypothesis stop = find_hypothesis(list_all(data, test::fit_whitened_baseline(data)), "bump_stop");
  REQUIRE(stop.parameters[1].key == "gap");
  const double low = stop.parameters[1].range.low;
  CHECK(low == Approx(0.1 * 0.02).epsilon(tolerance(0.01)));  // of the largest compression
  CHECK(make_unknowns(data, stop)[1].low == low);
  CHECK(is_plausible(data, stop, {100.0, 1.01 * low, 0.0}));
  CHECK_FALSE(is_plausible(data, stop, {100.0, low, 0.0}));
  // One of the model file that is met at rest may change.
  stop.reference[1] = 0.0;
  CHECK(make_unknowns(data, stop)[1].low == 0.0);
  stop.change = EffectChange::kChanged;
  CHECK(is_plausible(data, stop, {100.0, low, 0.0}));
  // Its removal has fewer values.
  const Hypothesis removal = make_removal(data, stop);
  REQUIRE(removal.parameters.size() < stop.parameters.size());
  CHECK(is_plausible(data, removal, removal.beginnings.front()));
}

TEST_CASE("A size at the limit of its range is not plausible", "[unit]") {
  const TemporaryFolder folder;
  const CampaignData data = read_series(folder);
  const std::vector<Hypothesis> all = list_all(data, test::fit_whitened_baseline(data));
  const auto is_possible = [&](const char* effect, const std::vector<double>& values) {
    Hypothesis h = find_hypothesis(all, effect);
    for (HypothesisParameter& p : h.parameters) p.range = {};
    return is_plausible(data, h, values);
  };
  CHECK(is_possible("damper_blow_off", {0.5, 0.03}));  // a shape may be at its limit
  CHECK_FALSE(is_possible("damper_blow_off", {0.98, 0.1}));
  CHECK_FALSE(is_possible("damper_asymmetry", {-0.9}));
  CHECK(is_possible("damper_asymmetry", {-0.89}));
  CHECK_FALSE(is_possible("damper_hysteresis", {0.05}));
  CHECK(is_possible("damper_hysteresis", {0.0}));
  CHECK(is_possible("strut_friction", {0.01, 1e-3, 0.0}));  // small beside a range up to 20 kN
}

double get_fitted(const Selection& selection, const std::string& name) {
  const FitResult& fit = selection.extended.fit;
  for (std::size_t i = 0; i < fit.unknowns.size(); ++i) {
    if (fit.unknowns[i].name == name) return fit.values[i];
  }
  return 0.0;
}

Selection find_friction_behind_play(const CampaignData& data, double force_tolerance) {
  SelectOptions options;
  options.threads = 2;
  Selection selection = select_causes(data, options);
  CHECK(has_cause(selection, {"joint_play"}));
  CHECK(has_cause(selection, {"strut_friction"}));
  // They are beside the final model, whose causes have parameters, too.
  REQUIRE_FALSE(selection.undetected.empty());
  CHECK(selection.undetected.front().shift.size() == selection.extended.shared_count);
  CHECK(get_fitted(selection, "joint_play") == Approx(4e-3).epsilon(tolerance(0.2)));
  CHECK(get_fitted(selection, "strut_friction_force") ==
        Approx(400.0).epsilon(tolerance(force_tolerance)));
  return selection;
}

TEST_CASE("Friction behind a play is found though a lag explains almost as much as friction",
          "[unit][slow]") {
  const TemporaryFolder folder;
  // The lag is not found, too; friction's stroke takes its part, and its force 8 %.
  const Selection selection = find_friction_behind_play(read_series(folder), 0.1);
  const SelectRound& first = selection.rounds.front();
  REQUIRE(first.candidates.size() > 1);
  CHECK(first.candidates[0].hypothesis.effect == "strut_friction");
  CHECK(first.candidates[1].hypothesis.effect == "damper_hysteresis");
  CHECK(first.pair_gain > first.candidates.front().gain);
  CHECK(first.candidates[1].gain > 0.8 * first.candidates.front().gain);
  // Of the force's mean square friction alone leaves a third.
  CHECK(selection.extended.fit.chi2 < 0.1 * selection.base.fit.chi2);
}

/// The spring takes part of what the play does, the play alone fits with a smaller value, and a lag
/// explains more than play or friction; with friction behind it, play explains most.
TEST_CASE("Friction behind a play is found though a spring is free and a lag explains more",
          "[unit][slow]") {
  const TemporaryFolder folder;
  const Selection selection =
      find_friction_behind_play(read_series(folder, "\"damping\", \"stiffness\""), 0.05);
  const SelectRound& first = selection.rounds.front();
  REQUIRE(first.candidates.size() > 1);
  CHECK(first.candidates[1].hypothesis.effect == "damper_hysteresis");
  REQUIRE(first.candidates.front().hypothesis.effect == "joint_play");
  CHECK(first.pair_gain > first.candidates.front().gain);
  CHECK(first.candidates.front().gain < first.candidates[1].gain);
}

}  // namespace
}  // namespace strut
