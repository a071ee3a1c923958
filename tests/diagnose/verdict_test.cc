// The verdict as one result: probabilities, claims and sentence agree, for many synthetic
// selections.
#include "diagnose/decide/verdict.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "base/math/random.h"
#include "diagnose/decide/diagnosis.h"
#include "diagnose/decide/improvement.h"
#include "diagnose/decide/sentence.h"
#include "tests/support/campaign_files.h"
#include "tests/support/tolerance.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::tolerance;

const CampaignData& get_campaign() {
  static const CampaignData data = [] {
    const test::TemporaryFolder folder;
    test::write_two_runs(folder);
    return read_campaign_data(test::write_campaign(folder));
  }();
  return data;
}

Candidate make_candidate(const EffectInfo& effect, double gain) {
  const ModelInfo& model = get_campaign().model();
  Candidate c;
  c.hypothesis.effect = effect.name;
  c.hypothesis.place = list_effect_places(effect, model).front();
  for (const EffectParameter* p : list_effect_parameters(effect, model)) {
    c.hypothesis.parameters.push_back({p->name, p->name, p->switches});
    c.values.push_back(p->typical);
    c.sigma.push_back(0.01 * std::abs(p->typical));
  }
  c.gain = gain;
  return c;
}

/// Numbers of a trial.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : seed_(seed) {}
  double get(double low, double high) {
    return low + (high - low) * calc_uniform(seed_, 0, place_++);
  }
  std::size_t pick(std::size_t count) {
    return static_cast<std::size_t>(get(0.0, static_cast<double>(count) - 1e-9));
  }

 private:
  std::uint64_t seed_, place_ = 0;
};

/// A round with the effects in an order of its own, the best first.
SelectRound make_round(Draw& draw) {
  SelectRound round;
  const double best = std::pow(10.0, draw.get(1.0, 6.0));
  round.misfit = draw.get(0.0, 1.0) < 0.5 ? 1.0 : draw.get(1.0, 300.0);
  double gain = best;
  const std::size_t first = draw.pick(list_effects().size());
  for (std::size_t i = 0; i < list_effects().size() && round.candidates.size() < 8; ++i) {
    const EffectInfo& effect = list_effects()[(first + 7 * i) % list_effects().size()];
    if (list_effect_places(effect, get_campaign().model()).empty()) continue;
    round.candidates.push_back(make_candidate(effect, gain));
    gain *= draw.get(0.2, 1.0);
  }
  return round;
}

/// A selection of up to three causes, each the best of its round that does not act already.
Selection make_selection(Draw& draw) {
  Selection s;
  const std::size_t count = draw.pick(4);
  for (std::size_t i = 0; i < count; ++i) {
    s.rounds.push_back(make_round(draw));
    for (const Candidate& c : s.rounds.back().candidates) {
      const bool acts = std::any_of(s.causes.begin(), s.causes.end(), [&](const Hypothesis& h) {
        return h.effect == c.hypothesis.effect && h.place == c.hypothesis.place;
      });
      if (acts) continue;
      s.causes.push_back(c.hypothesis);
      s.round_of.push_back(i);
      s.gains.push_back(c.gain);
      break;
    }
  }
  s.rounds.push_back(make_round(draw));
  s.is_left = draw.get(0.0, 1.0) < 0.5;
  if (s.is_left) s.left.energy = std::pow(10.0, draw.get(0.0, 7.0));
  s.left.band = {3.0, 8.0};
  return s;
}

/// A diagnosis as diagnose_campaign concludes it from a selection.
Diagnosis conclude(Draw& draw) {
  Diagnosis d;
  d.selection = make_selection(draw);
  d.verdict = make_claim(get_campaign().model(), d.selection);
  if (d.verdict.positions.empty() && !d.selection.causes.empty()) d.selection.is_left = true;
  if (draw.get(0.0, 1.0) < 0.3) d.verdict.misfits.push_back({1, "", 9, draw.get(2.0, 30.0), 1.1});
  d.improvement.explained = draw.get(0.1, 1.0);
  d.verdict.conclude(d.selection.is_left, false);
  d.sentence = write_sentence(get_campaign(), d);
  return d;
}

/// Whether a text has a name that is not part of a longer one.
bool has_word(const std::string& text, const std::string& word) {
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    const char before = at == 0 ? ' ' : text[at - 1];
    const char after = at + word.size() < text.size() ? text[at + word.size()] : ' ';
    if (before != '_' && after != '_') return true;
  }
  return false;
}

TEST_CASE("No verdict contradicts itself", "[property]") {
  int claims = 0, unknowns = 0;
  for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
    Draw draw(seed);
    const Diagnosis d = conclude(draw);
    const Verdict& v = d.verdict;
    INFO(seed << ": " << d.sentence);
    REQUIRE_NOTHROW(check_verdict(v, false));
    for (const CausePosition& p : v.positions) {
      double sum = p.unknown;
      for (const Cause& c : p.candidates) sum += c.probability;
      CHECK(sum == Approx(1.0).epsilon(tolerance(1e-12)));
      CHECK(p.calc_claimed() > p.unknown);
      for (const Cause& c : p.list_close()) CHECK(has_word(d.sentence, c.effect));
    }
    for (const Cause& c : v.list_runners_up()) {
      CHECK(has_word(d.sentence, c.effect) == false);
    }
    // extended.toml has the causes of the selection, which is withdrawn where none is claimed.
    if (!v.positions.empty()) CHECK(v.list_causes().size() == d.selection.causes.size());
    if (!v.misfits.empty()) {
      CHECK((v.kind == VerdictKind::kFormIncomplete || v.kind == VerdictKind::kUnknown));
    }
    claims += v.positions.empty() ? 0 : 1;
    unknowns += v.kind == VerdictKind::kUnknown ? 1 : 0;
  }
  CHECK(claims > 500);
  CHECK(unknowns > 200);
}

TEST_CASE("Causes that act together are no alternatives of each other", "[unit]") {
  const EffectInfo &friction = *find_effect("strut_friction"), &spring = *find_effect("bump_stop");
  Selection s;
  s.rounds.resize(3);
  s.rounds[0].candidates = {make_candidate(friction, 100.0), make_candidate(spring, 99.0)};
  s.rounds[1].candidates = {make_candidate(spring, 90.0)};
  s.causes = {s.rounds[0].candidates[0].hypothesis, s.rounds[1].candidates[0].hypothesis};
  s.round_of = {0, 1};
  s.gains = {100.0, 90.0};
  const Verdict v = make_claim(get_campaign().model(), s);
  REQUIRE(v.positions.size() == 2);
  CHECK(v.list_group().empty());
  // One candidate at each position: 1 less the smallest probability of none, 0.02.
  CHECK(v.list_causes()[0].probability == Approx(0.98).epsilon(tolerance(1e-12)));
  // The second explains 0.9 of what the first does.
  CHECK(v.list_causes()[1].probability == Approx(0.98 * 0.9 / 0.93).epsilon(tolerance(1e-12)));
}

TEST_CASE("Two equal fits share the probability", "[unit]") {
  Selection s;
  s.rounds.resize(2);
  s.rounds[0].candidates = {make_candidate(*find_effect("sensor_delay"), 100.0),
                            make_candidate(*find_effect("sensor_lowpass"), 100.0)};
  s.causes = {s.rounds[0].candidates[0].hypothesis};
  s.round_of = {0};
  s.gains = {100.0};
  const Verdict v = make_claim(get_campaign().model(), s);
  REQUIRE(v.list_group().size() == 2);
  CHECK(v.list_group()[1].probability == Approx(0.49).epsilon(tolerance(1e-12)));
}

/// A selection of the first of two candidates that differ by this many log odds.
Selection make_pair(double odds) {
  // Half of the difference of chi2, blurred by 1 + 0.004 * 100.
  const double gain = 100.0 - 2.0 * 1.4 * odds;
  Selection s;
  s.rounds.resize(2);
  s.rounds[0].candidates = {make_candidate(*find_effect("sensor_delay"), 100.0),
                            make_candidate(*find_effect("sensor_lowpass"), gain)};
  s.rounds[0].candidates[1].alias = 1;
  s.causes = {s.rounds[0].candidates[0].hypothesis};
  s.round_of = {0};
  s.gains = {100.0};
  return s;
}

TEST_CASE("Candidates within log odds of 3 are a group, others share the probability by odds",
          "[unit]") {
  CHECK(make_claim(get_campaign().model(), make_pair(2.9)).list_group().size() == 2);
  const Verdict v = make_claim(get_campaign().model(), make_pair(3.1));
  CHECK(v.list_group().empty());
  REQUIRE(v.positions.size() == 1);
  const double ratio = std::exp(-3.1);
  CHECK(v.positions[0].candidates[0].probability ==
        Approx(0.98 / (1.0 + ratio)).epsilon(tolerance(1e-9)));
  CHECK(v.positions[0].candidates[1].probability ==
        Approx(0.98 * ratio / (1.0 + ratio)).epsilon(tolerance(1e-9)));
}

TEST_CASE("A group is limited by the model's form from twice the expected chi2 on", "[unit]") {
  Selection s = make_pair(0.0);
  s.rounds[0].misfit = 1.9;
  CHECK_FALSE(make_claim(get_campaign().model(), s).positions[0].is_limited_by_form);
  s.rounds[0].misfit = 2.1;
  CHECK(make_claim(get_campaign().model(), s).positions[0].is_limited_by_form);
}

TEST_CASE("A verdict is complete only without a map and without a residual", "[unit]") {
  using K = VerdictKind;
  // Causes, group, map, residual of the fitted runs, adequate.
  CHECK(judge({false, false, false, false, true}) == K::kAdequate);
  CHECK(judge({false, false, false, false, false}) == K::kUnknown);
  CHECK(judge({false, false, false, true, true}) == K::kUnknown);
  CHECK(judge({false, false, true, false, true}) == K::kUnknown);
  CHECK(judge({true, false, false, false, true}) == K::kNamed);
  CHECK(judge({true, true, false, false, true}) == K::kGroup);
  CHECK(judge({true, true, true, false, true}) == K::kFormIncomplete);
  CHECK(judge({true, false, false, true, true}) == K::kFormIncomplete);
  CHECK(judge({true, false, false, false, false}) == K::kFormIncomplete);
}

TEST_CASE("A cause that leaves more than it takes is not claimed", "[unit]") {
  Selection s;
  s.rounds.resize(2);
  s.rounds[0].candidates = {make_candidate(*find_effect("bump_stop"), 10.8)};
  s.causes = {s.rounds[0].candidates[0].hypothesis};
  s.round_of = {0};
  s.gains = {10.8};
  s.is_left = true;
  s.left.energy = 89.2;
  // 1 / (1 + exp((0.5 - 0.892) / 0.08))
  CHECK(calc_unknown(s) == Approx(0.99260).epsilon(tolerance(1e-4)));
  const Verdict v = make_claim(get_campaign().model(), s);
  CHECK(v.positions.empty());
  REQUIRE(v.rejected.size() == 1);
  CHECK(v.rejected.front().probability + v.unknown_share == Approx(1.0).epsilon(tolerance(1e-9)));
  // A map that explains nine tenths of the residual completes the form of the cause.
  CHECK(make_claim(get_campaign().model(), s, 0.9).positions.size() == 1);
}

TEST_CASE("A cause that is small beside another is less probable", "[unit]") {
  Selection s;
  s.rounds.resize(2);
  s.rounds[0].candidates = {make_candidate(*find_effect("damper_asymmetry"), 1000.0)};
  s.rounds[1].candidates = {make_candidate(*find_effect("bump_stop"), 100.0)};
  s.causes = {s.rounds[0].candidates[0].hypothesis, s.rounds[1].candidates[0].hypothesis};
  s.round_of = {0, 1};
  s.gains = {1000.0, 100.0};
  const Verdict v = make_claim(get_campaign().model(), s);
  REQUIRE(v.positions.size() == 2);
  CHECK(v.positions[0].calc_claimed() == Approx(0.98));
  // 0.1 / (0.1 + 0.03)
  CHECK(v.positions[1].calc_claimed() == Approx(0.98 * 0.1 / 0.13));
  CHECK(v.positions[1].unknown == Approx(1.0 - 0.98 * 0.1 / 0.13));
  // As small as it may be, it is still more probable than nothing of the catalogue.
  s.gains[1] = 1.0;
  const Verdict least = make_claim(get_campaign().model(), s);
  REQUIRE(least.positions.size() == 2);
  CHECK(least.positions[1].calc_claimed() == Approx(0.98 * 0.035 / 0.065));
}

TEST_CASE("The interval of a cause's parameter is 1.96 standard errors to either side", "[unit]") {
  Selection s;
  s.rounds.resize(2);
  s.rounds[0].candidates = {make_candidate(*find_effect("damper_asymmetry"), 100.0)};
  Candidate& c = s.rounds[0].candidates[0];
  c.values = {0.3};
  c.sigma = {0.01};
  s.causes = {c.hypothesis};
  s.round_of = {0};
  s.gains = {100.0};
  const CauseParameter p =
      make_claim(get_campaign().model(), s).list_causes()[0].parameters.front();
  CHECK(p.low == Approx(0.3 - 0.0195996).epsilon(tolerance(1e-6)));
  CHECK(p.high == Approx(0.3 + 0.0195996).epsilon(tolerance(1e-6)));
  CHECK_FALSE(p.at_bound);
}

TEST_CASE("The interval of a claimed cause is widened by the misfit", "[unit]") {
  Selection s;
  s.rounds.resize(2);
  s.rounds[0].candidates = {make_candidate(*find_effect("damper_asymmetry"), 100.0)};
  s.causes = {s.rounds[0].candidates[0].hypothesis};
  s.round_of = {0};
  s.gains = {100.0};
  s.extended.shared_count = 1;
  Unknown u;
  u.name = s.causes[0].parameters[0].name;
  s.extended.fit.unknowns = {u};
  s.extended.fit.values = {0.25};
  s.extended.fit.uncertainty.sigma = {0.01};
  s.extended.fit.widened.sigma = {0.03};
  const CauseParameter p =
      make_claim(get_campaign().model(), s).list_causes()[0].parameters.front();
  CHECK(p.value == 0.25);
  CHECK(p.low == Approx(0.25 - 0.0587989).epsilon(tolerance(1e-6)));
  CHECK(p.high == Approx(0.25 + 0.0587989).epsilon(tolerance(1e-6)));
}

TEST_CASE("An extension is an improvement only where the held-out runs agree", "[unit]") {
  Improvement better;
  better.hold_out = {20.0, 20.0};
  better.excess_before = 2.0;
  better.excess_after = 0.5;
  CHECK(is_improved(better));
  Improvement unlikely = better, worse = better;
  unlikely.hold_out = {-20.0, 20.0};
  CHECK_FALSE(is_improved(unlikely));
  worse.excess_after = 3.0;
  CHECK_FALSE(is_improved(worse));
}

TEST_CASE("Errors of the held-out runs may grow by a twentieth of a floor", "[unit]") {
  Improvement i;
  i.hold_out.fall = 2e-3;
  i.excess_before = 2.0;
  i.excess_after = 2.049;
  CHECK(is_improved(i));
  i.excess_after = 2.051;
  CHECK_FALSE(is_improved(i));
  i.excess_after = 2.0;
  i.hold_out.fall = -2e-3;
  CHECK_FALSE(is_improved(i));
}

TEST_CASE("Held-out log odds favor the model under which the runs are more likely", "[unit]") {
  Selection s;
  HoldOutRun before, after, failed;
  before.log_likelihood = -120.0;
  before.chi2 = 240.0;
  after.chi2 = 200.0;
  after.log_likelihood = -100.0;
  before.count = after.count = failed.count = 40;
  failed.failure = "lost contact";
  failed.log_likelihood = 1e6;
  s.hold_out_before = {before, before};
  s.hold_out_after = {after, failed};  // a run without both models counts for neither
  const Improvement improvement = calc_improvement(get_campaign(), s, {});
  CHECK(improvement.hold_out.fall == Approx(40.0).epsilon(tolerance(1e-12)));
  CHECK(improvement.log_likelihood_after == Approx(-2.5).epsilon(tolerance(1e-12)));
}

/// Held-out residuals before and after in units of the noise, for one channel of 1000 readings.
DiagnosedRun make_run(double before, double after) {
  DiagnosedRun run;
  run.run = 1;
  const auto make = [](double rms) {
    ChannelComparison c;
    c.channel = get_campaign().channels(1).front().channel;
    c.count = 1000;
    c.rms = rms;
    c.measured_spread = 10.0;
    c.adequacy = {{1.0, 0.0, 0.0}, 1000, rms};
    ModelComparison model;
    model.channels = {c};
    return model;
  };
  run.before = make(before);
  run.after = make(after);
  return run;
}

/// A verdict that claims a bump stop.
Diagnosis make_claimed(VerdictKind kind) {
  Diagnosis d;
  d.verdict.kind = kind;
  CausePosition position;
  position.candidates = {{"bump_stop", "", 0.98, 9.0, {}}};
  position.unknown = d.verdict.unknown_share = 0.02;
  d.verdict.positions = {position};
  return d;
}

TEST_CASE("The stated improvement is the measured one", "[unit]") {
  Selection s;
  const int channel = get_campaign().channels(1).front().channel;
  const NoiseFloor noise{1.0, 0.0, get_campaign().find_noise(channel).uncertainty};
  const double floor = 1.0 + calc_floor_tolerance(noise, 1000);
  const Improvement i = calc_improvement(get_campaign(), s, {make_run(floor + 2.0, floor + 0.5)});
  REQUIRE(i.explained);
  CHECK(*i.explained == Approx(0.75).epsilon(tolerance(1e-9)));
  CHECK(i.channels.front().rms_after == Approx(floor + 0.5).epsilon(tolerance(1e-12)));
  Diagnosis d = make_claimed(VerdictKind::kNamed);
  d.improvement = i;
  const std::string percent = std::to_string(static_cast<int>(std::lround(100.0 * *i.explained)));
  CHECK_THAT(write_sentence(get_campaign(), d), Contains("removes " + percent + " %"));
}

TEST_CASE("An extension that lowers the likelihood within noise is said to", "[unit]") {
  Diagnosis d = make_claimed(VerdictKind::kNamed);
  d.improvement.explained = 0.75;
  d.improvement.hold_out = {-1.1, 4.0};
  CHECK_THAT(write_sentence(get_campaign(), d),
             Contains("lowers the log-likelihood of the held-out runs by 0.55, within three"));
}

TEST_CASE("An unknown cause is described by what was refused and by a residual that stands out",
          "[unit]") {
  Diagnosis d;
  d.verdict.kind = VerdictKind::kUnknown;
  d.selection.is_left = true;
  d.selection.refusal = Refusal::kContradicted;
  d.selection.refused = "bump_stop";
  d.where.band = "9 to 10 Hz";  // of the residual's largest part, which is noise
  CHECK(write_sentence(get_campaign(), d) ==
        "Cause: none of the catalogue; bump_stop fits the runs for fitting, but the held-out runs "
        "contradict it.");
  d.selection.left.significance = 6.1;
  CHECK_THAT(write_sentence(get_campaign(), d), Contains("catalogue; at 9 to 10 Hz; bump_stop"));
  d.selection.refusal = Refusal::kUnstable;
  CHECK_THAT(write_sentence(get_campaign(), d), Contains("Cause: unknown; at"));
}

TEST_CASE("Every sentence on something that remains says what", "[unit]") {
  for (const Refusal refusal :
       {Refusal::kContradicted, Refusal::kUnstable, Refusal::kImplausible, Refusal::kSmall}) {
    Diagnosis d = make_claimed(VerdictKind::kFormIncomplete);
    d.selection.is_left = true;
    d.selection.refusal = refusal;
    d.selection.refused = "damper_fade";
    CHECK_THAT(write_sentence(get_campaign(), d), Contains("Incomplete: ") && Contains(" fit"));
  }
}

TEST_CASE("A channel that an extension worsens is told", "[unit]") {
  CHECK(list_worsened(get_campaign(), {make_run(3.0, 1.0)}).empty());
  CHECK(list_worsened(get_campaign(), {make_run(0.8, 1.0)}).empty());    // within its noise
  CHECK(list_worsened(get_campaign(), {make_run(10.0, 10.4)}).empty());  // by a twentieth
  CHECK(list_worsened(get_campaign(), {make_run(10.0, 10.6)}).size() == 1);
  const auto worsened = list_worsened(get_campaign(), {make_run(10.5, 17.0)});
  REQUIRE(worsened.size() == 1);
  CHECK_THAT(worsened.front(), Contains("b.csv (held out), from 10.5 to 17 times its noise"));
}

}  // namespace
}  // namespace strut
