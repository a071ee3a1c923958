#include "diagnose/decide/select.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "base/error/input_error.h"
#include "diagnose/decide/acceptance.h"
#include "diagnose/decide/effect_round.h"
#include "diagnose/decide/extended_unknowns.h"
#include "model/effects/names.h"

namespace strut {
namespace {

class Selector {
 public:
  Selector(const CampaignData& data, const SelectOptions& options)
      : data_(data), options_(options) {}

  Selection run() {
    tell("calibrating the baseline");
    FitOptions quick;
    quick.iterations = data_.has_inputs() ? 50 : 5;
    const Baseline baseline = calibrate_baseline(data_, options_.threads, quick);
    if (!baseline.is_fitted) {
      throw InputError(data_.campaign.path.string() +
                       ": fit.free: nothing is free; a diagnosis needs what may be adjusted");
    }
    const std::vector<NoiseSpectrum> spectra = measure_noise(data_, baseline, options_.threads);
    selection_.base = fit_excited(baseline, spectra);
    selection_.extended = selection_.base;
    tell("judging the runs held out");
    selection_.judge =
        std::make_shared<const HoldOutJudge>(data_, selection_.base, options_.threads);
    selection_.hold_out_before = judge(selection_.base);
    selection_.hold_out_after = selection_.hold_out_before;
    const int most =
        selection_.base.is_dominated ? options_.most_causes_dominated : options_.most_causes;
    constexpr int kPasses = 2;
    for (int pass = 0; pass < kPasses; ++pass) {
      while (static_cast<int>(selection_.causes.size()) < most && add(most)) {
      }
      last_ = selection_.rounds.back();
      is_last_current_ = !reconsider();
      if (is_last_current_) break;
    }
    measure_left();
    return std::move(selection_);
  }

 private:
  /// The fit over the runs that meet a bump: level ones, often long, tell the roughness of the road
  /// and hardly more. All runs where none meets one.
  WhitenedFit fit_excited(const Baseline& baseline, const std::vector<NoiseSpectrum>& spectra) {
    std::vector<std::size_t> runs;
    std::vector<NoiseSpectrum> chosen;
    std::vector<std::optional<int>> number(baseline.runs.size());
    const bool all = std::none_of(baseline.runs.begin(), baseline.runs.end(),
                                  [&](std::size_t run) { return meets_bump(data_, run); });
    for (std::size_t i = 0; i < baseline.runs.size(); ++i) {
      if (!all && !meets_bump(data_, baseline.runs[i])) continue;
      number[i] = static_cast<int>(runs.size());
      runs.push_back(baseline.runs[i]);
      chosen.push_back(spectra[i]);
    }
    std::vector<Unknown> unknowns;
    std::vector<double> values;
    for (std::size_t i = 0; i < baseline.fit.unknowns.size(); ++i) {
      Unknown u = baseline.fit.unknowns[i];
      if (u.run != kEveryRun) {
        const std::optional<int> kept = number[static_cast<std::size_t>(u.run)];
        if (!kept) continue;
        u.run = *kept;
      }
      unknowns.push_back(std::move(u));
      values.push_back(baseline.fit.values[i]);
    }
    const auto fit = [&](const RunNoise& noise, const std::vector<double>& start) {
      return fit_whitened(data_, runs, noise, unknowns, start, baseline.shared_count(),
                          options_.threads);
    };
    if (!data_.has_inputs() && !all && chosen.front().level > 0.0) {
      const RoughStart start =
          search_without_roads(data_, runs, chosen, unknowns, values, options_.threads);
      if (!start.is_dominated) return fit({chosen, make_smooth_roads(data_, runs)}, start.values);
      values = start.values;
    }
    return fit({chosen}, values);
  }

  void tell(const std::string& what) const {
    if (options_.progress) options_.progress(what);
  }

  std::vector<HoldOutRun> judge(const WhitenedFit& fit) const {
    return selection_.judge->judge(fit.shared());
  }

  void measure_left() {
    const WhitenedFit& now = selection_.extended;
    TestBench bench(data_, now, options_.threads);
    selection_.left = measure_leftover(data_, bench, options_.leftover);
    selection_.undetected =
        is_last_current_ && !last_.accepted ? last_.undetected : find_undetected(data_, now, bench);
    selection_.simulations += bench.simulation_count();
    selection_.is_left = is_significant(selection_.left, options_.leftover);
    if (!is_last_current_) return;
    const Rejected rejected = find_rejected(selection_, last_);
    if (rejected.reason == Refusal::kNone) return;
    selection_.is_left = true;
    selection_.left.energy = std::max(selection_.left.energy, rejected.gain);
    selection_.refusal = rejected.reason;
    if (!last_.candidates.empty()) {
      selection_.refused = last_.candidates.front().hypothesis.describe();
    }
  }

  /// One round, or two; whether causes were added.
  bool add(int most) {
    test_beside_causes();
    if (accept(Confirmation::kAlone)) return true;
    const auto left = static_cast<std::size_t>(most) - selection_.causes.size();
    return selection_.extended.is_dominated && left >= 2 && add_pair();
  }

  void test_beside_causes() {
    tell("testing every effect" +
         (selection_.causes.empty() ? "" : " beside " + selection_.causes.back().describe()));
    SelectRound round = test_effects(data_, selection_.extended, options_, {options_.fitted});
    look_ahead(round);
    selection_.simulations += round.simulations;
    selection_.rounds.push_back(std::move(round));
  }

  /// Two causes that the held-out runs confirm together, though not the first alone: play does not
  /// help where the friction behind it is missing.
  bool add_pair() {
    const Selection kept = selection_;
    if (!(kept.rounds.back().pair_gain > 0.0) || !accept(Confirmation::kLater)) return false;
    test_beside_causes();
    if (accept(Confirmation::kLater) &&
        is_confirmed(kept, selection_.rounds.back(), selection_.hold_out_after, options_)) {
      return true;
    }
    const long simulations = selection_.simulations;
    selection_ = kept;
    selection_.simulations = simulations;
    return false;
  }

  /// The best alone may be a third effect that imitates two others together. For the best of each
  /// class, the best second effect is looked up, and that of the best pair leads the round.
  void look_ahead(SelectRound& round) {
    constexpr double kExplained = 1.2;
    if (!data_.has_inputs() || round.candidates.size() < 2 || round.misfit < kExplained) return;
    if (round.candidates.front().gain < round.threshold * round.misfit) return;
    tell("looking for pairs of effects");
    // By score, then the best by fits.
    std::vector<Pair> pairs = list_pairs(round);
    std::vector<double> gains(round.candidates.size(), 0.0);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      if (i >= options_.paired_fits && pairs[i].candidate != 0) continue;
      const Candidate& c = round.candidates[pairs[i].candidate];
      const SelectRound beside = test_beside(c, options_.partners);
      round.simulations += beside.simulations;
      gains[pairs[i].candidate] =
          c.gain + (beside.candidates.empty() ? 0.0 : beside.candidates.front().gain);
    }
    const std::size_t lead = choose_lead(gains, round.threshold * round.misfit);
    round.pair_gain = gains[lead];
    const auto at = round.candidates.begin() + static_cast<std::ptrdiff_t>(lead);
    std::rotate(round.candidates.begin(), at, at + 1);
  }

  /// A candidate, and the delta chi2 that it promises with the best second effect.
  struct Pair {
    std::size_t candidate;
    double promise;
  };

  /// Pairs of the best of each class, the most promising first.
  std::vector<Pair> list_pairs(SelectRound& round) const {
    const std::size_t count = selection_.causes.empty() ? options_.paired : options_.paired_later;
    std::vector<std::size_t> classes;
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i < round.candidates.size() && pairs.size() < count; ++i) {
      const Candidate& c = round.candidates[i];
      // Beside friction a worn joint is no twin of a lost stroke.
      const bool is_joint = c.hypothesis.effect == EffectName::kJointPlay;
      if (!is_joint && std::find(classes.begin(), classes.end(), c.alias) != classes.end())
        continue;
      classes.push_back(c.alias);
      const SelectRound beside = test_beside(c, 0);
      round.simulations += beside.simulations;
      pairs.push_back({i, c.gain + beside.best_score});
    }
    std::stable_sort(pairs.begin(), pairs.end(),
                     [](const Pair& a, const Pair& b) { return a.promise > b.promise; });
    return pairs;
  }

  SelectRound test_beside(const Candidate& c, std::size_t fitted) const {
    RoundOptions quick{fitted};
    quick.is_final = false;
    return test_effects(data_, adopt(data_, selection_.extended, c), options_, quick);
  }

  /// With several causes, each was chosen without those that came later: each is taken out, every
  /// effect tested beside the others, and the cause replaced where another does better, or dropped
  /// where it is not needed any more. Whether any was.
  bool reconsider() {
    bool has_changed = false;
    for (std::size_t i = 0, tries = selection_.causes.size();
         tries > 0 && i < selection_.causes.size() && selection_.causes.size() > 1; --tries) {
      const bool is_replaced = replace(i);
      has_changed = has_changed || is_replaced;
      if (!is_replaced) ++i;  // what replaces a cause stands last
    }
    return has_changed;
  }

  /// Takes a cause out, and puts what does better in its place; whether there is such.
  bool replace(std::size_t i) {
    const Selection kept = selection_;
    const Hypothesis removed = kept.causes[i];
    tell("reconsidering " + removed.describe());
    take_out(i);
    RoundOptions round_options{options_.fitted / 2};
    round_options.also = &removed;
    round_options.values = get_values(kept.extended, removed);
    SelectRound round = test_effects(data_, selection_.extended, options_, round_options);
    const long simulations = selection_.simulations + round.simulations;
    const bool is_needed = is_large(selection_, round, options_);
    const bool is_best = is_needed && is_same_effect(round.candidates.front().hypothesis, removed);
    bool is_replaced = !is_needed;
    if (is_needed && !is_best) {
      selection_.rounds.push_back(round);
      is_replaced = accept(Confirmation::kAlone) &&
                    sum_chi2(selection_.hold_out_after) < sum_chi2(kept.hold_out_after);
    }
    if (!is_replaced) {
      selection_ = kept;
      keep_round(i, std::move(round));
    }
    selection_.simulations = simulations;
    return is_replaced;
  }

  /// That of the last fit: one level of the road for all that are compared.
  RunNoise get_noise() const {
    return {selection_.extended.spectra, selection_.extended.roads, true};
  }

  void take_out(std::size_t i) {
    const ExtendedUnknowns e = remove(selection_.extended, selection_.causes[i]);
    const auto at = static_cast<std::ptrdiff_t>(i);
    selection_.causes.erase(selection_.causes.begin() + at);
    selection_.round_of.erase(selection_.round_of.begin() + at);
    selection_.gains.erase(selection_.gains.begin() + at);
    selection_.extended = fit_whitened(data_, selection_.extended.runs, get_noise(), e.unknowns,
                                       e.values, e.shared_count, options_.threads);
    selection_.hold_out_after = judge(selection_.extended);
  }

  /// Fits the causes together with what is added. The first was found alone: beside a later one it
  /// may belong into another valley (the play of a joint, once friction stands behind it). Where
  /// the model's error dominates, fits therefore begin at less and at more of each earlier cause,
  /// too.
  WhitenedFit fit_extended(const ExtendedUnknowns& e) const {
    constexpr std::array<double, 2> kSizes = {0.4, 2.5};
    const auto fit = [&](const std::vector<double>& start) {
      return fit_whitened(data_, selection_.extended.runs, get_noise(), e.unknowns, start,
                          e.shared_count, options_.threads);
    };
    WhitenedFit best = fit(e.values);
    if (!data_.has_inputs() || !best.is_dominated) return best;
    const std::vector<double> values = best.fit.values;
    for (const Hypothesis& cause : selection_.causes) {
      for (const double size : kSizes) {
        WhitenedFit other = fit(scale_size(e, values, cause, size));
        if (other.fit.chi2 < best.fit.chi2) best = std::move(other);
      }
    }
    return best;
  }

  static std::vector<double> scale_size(const ExtendedUnknowns& e, std::vector<double> values,
                                        const Hypothesis& cause, double size) {
    for (std::size_t j = 0; j < cause.parameters.size(); ++j) {
      if (!cause.parameters[j].switches) continue;
      for (std::size_t i = 0; i < e.shared_count; ++i) {
        const Unknown& u = e.unknowns[i];
        if (u.name != cause.parameters[j].name) continue;
        const double reference = cause.reference[j];
        values[i] = std::clamp(reference + size * (values[i] - reference), u.low, u.high);
      }
    }
    return values;
  }

  /// A cause's own round becomes that beside all others.
  void keep_round(std::size_t i, SelectRound round) {
    const auto own = std::find_if(
        round.candidates.begin(), round.candidates.end(),
        [&](const Candidate& c) { return is_same_effect(c.hypothesis, selection_.causes[i]); });
    if (own == round.candidates.end()) return;
    round.accepted = true;
    selection_.gains[i] = own->gain;
    selection_.round_of[i] = selection_.rounds.size();
    selection_.rounds.push_back(std::move(round));
  }

  static std::vector<double> get_values(const WhitenedFit& fit, const Hypothesis& h) {
    std::vector<double> values;
    for (const HypothesisParameter& p : h.parameters) {
      for (std::size_t i = 0; i < fit.shared_count; ++i) {
        if (fit.fit.unknowns[i].name == p.name) values.push_back(fit.fit.values[i]);
      }
    }
    return values;
  }

  /// Whether a cause that was within its range alone is at a limit beside the others.
  bool ends_at_limit(const WhitenedFit& fit, const Hypothesis& h) const {
    const std::vector<double> values = get_values(fit, h);
    return values.size() == h.parameters.size() && !is_plausible(data_, h, values);
  }

  enum class Confirmation { kAlone, kLater };

  /// Makes the best of the last round a cause if it is large and the held-out runs confirm it.
  bool accept(Confirmation confirmation) {
    SelectRound& round = selection_.rounds.back();
    if (!is_large(selection_, round, options_)) {
      const bool is_first = selection_.causes.empty() && !round.candidates.empty();
      if (is_first && !selection_.extended.is_dominated && is_unstable(round, options_)) {
        round.refusal = Refusal::kUnstable;
      }
      return false;
    }
    const Candidate& best = round.candidates.front();
    const ExtendedUnknowns e =
        extend(data_, selection_.extended, best.hypothesis, best.base_values, best.values);
    tell("fitting with " + best.hypothesis.describe());
    WhitenedFit fit = fit_extended(e);
    if (ends_at_limit(fit, best.hypothesis)) {
      round.refusal = Refusal::kImplausible;
      return false;
    }
    std::vector<HoldOutRun> judged = judge(fit);
    if (confirmation == Confirmation::kAlone &&
        !is_confirmed(selection_, round, judged, options_)) {
      if (is_contradicted(selection_, round, judged)) round.refusal = Refusal::kContradicted;
      return false;
    }
    round.accepted = true;
    round.refusal = Refusal::kNone;
    selection_.extended = std::move(fit);
    selection_.hold_out_after = std::move(judged);
    selection_.causes.push_back(best.hypothesis);
    selection_.round_of.push_back(selection_.rounds.size() - 1);
    selection_.gains.push_back(best.gain);
    return true;
  }

  const CampaignData& data_;
  const SelectOptions& options_;
  Selection selection_;
  SelectRound last_;             // the last that looked for a further cause
  bool is_last_current_ = true;  // no cause has changed since
};

}  // namespace

Selection select_causes(const CampaignData& data, const SelectOptions& options) {
  return Selector(data, options).run();
}

}  // namespace strut
