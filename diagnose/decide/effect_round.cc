#include "diagnose/decide/effect_round.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/math/normal.h"
#include "base/parallel/team.h"
#include "diagnose/decide/acceptance.h"
#include "diagnose/decide/extended_unknowns.h"

namespace strut {
namespace {

/// The reference moved by the start's difference from it times `amplitude`, within what is allowed.
std::vector<double> scale_beginning(const CampaignData& data, const Hypothesis& h,
                                    const HypothesisTrial& trial,
                                    const Eigen::VectorXd& amplitude) {
  const std::vector<Unknown> unknowns = make_unknowns(data, h);
  std::vector<double> values = h.beginnings[trial.beginning];
  for (std::size_t j = 0; j < trial.parameters.size(); ++j) {
    const std::size_t i = trial.parameters[j];
    const double size = amplitude(static_cast<Eigen::Index>(j)) * (values[i] - h.reference[i]);
    values[i] = std::clamp(h.reference[i] + size, unknowns[i].low, unknowns[i].high);
  }
  return values;
}

/// A beginning with the sizes that the score asks for, but not too far: what is linear at first may
/// not stay so.
std::vector<double> make_beginning(const CampaignData& data, const Hypothesis& h,
                                   const HypothesisTrial& trial, const Gain& gain) {
  constexpr double kMax = 10.0;
  return scale_beginning(data, h, trial, gain.amplitude.cwiseMax(-kMax).cwiseMin(kMax));
}

/// All that runs share at a hypothesis' fit.
SharedValues make_shared(const WhitenedFit& base, const Hypothesis& h, const HypothesisFit& fit) {
  SharedValues shared = base.shared();
  std::copy_n(fit.values.begin(), base.shared_count, shared.values.begin());
  const std::size_t first = base.fit.unknowns.size();
  for (std::size_t i = 0; i < h.parameters.size(); ++i) {
    Unknown u;
    u.name = h.parameters[i].name;
    shared.unknowns.push_back(std::move(u));
    shared.values.push_back(fit.values[first + i]);
  }
  return shared;
}

/// For each of the ranked, one before it whose first beginning does the same to all readings: what
/// no data tell apart is fitted once. Itself where there is none.
std::vector<std::size_t> find_twins(const std::vector<RankedTrial>& ranked,
                                    const std::vector<std::vector<double>>& beginnings) {
  constexpr double kSame = 1e-9;
  std::vector<std::size_t> twins;
  for (std::size_t i = 0; i < ranked.size(); ++i) {
    std::size_t twin = 0;
    while (twin < i &&
           (beginnings[twin] != beginnings[i] ||
            std::abs(ranked[twin].gain.chi2 - ranked[i].gain.chi2) > kSame * ranked[i].gain.chi2)) {
      ++twin;
    }
    twins.push_back(twin);
  }
  return twins;
}

/// The fit of its twin under the hypothesis' own names.
Candidate rename(Candidate twin, const Hypothesis& h) {
  twin.hypothesis = h;
  twin.simulations = 0;
  if (twin.values.empty()) return twin;
  const std::size_t first = twin.shared.unknowns.size() - h.parameters.size();
  for (std::size_t i = 0; i < h.parameters.size(); ++i) {
    twin.shared.unknowns[first + i].name = h.parameters[i].name;
  }
  return twin;
}

/// Input of all fits of a round.
struct Round {
  const CampaignData& data;
  const WhitenedFit& now;
  const SelectOptions& options;
  const TestBench& bench;
  const std::vector<Hypothesis>& hypotheses;
  const Evidence& evidence;
};

/// A candidate with the point from which its search can go on.
struct Fitted {
  Candidate candidate;
  std::vector<double> beginning, values;
};

Fitted keep_fit(const Round& round, const Hypothesis& h, const HypothesisFit& fit,
                std::vector<double> beginning) {
  Fitted f;
  Candidate& c = f.candidate;
  c.hypothesis = h;
  c.gain = fit.gain;
  c.sigma = fit.sigma;
  c.distance = fit.distance;
  c.converged = fit.converged;
  c.simulations = fit.simulations;
  f.beginning = std::move(beginning);
  f.values = fit.values;
  if (!fit.failure.empty()) return f;
  const auto base = static_cast<std::ptrdiff_t>(round.bench.values().size());
  c.base_values.assign(fit.values.begin(), fit.values.begin() + base);
  c.values.assign(fit.values.begin() + base, fit.values.end());
  c.shared = make_shared(round.now, h, fit);
  return f;
}

/// Keeps the better of two fits, and counts the simulations of both.
void improve(Fitted& fitted, Fitted other) {
  const bool is_better =
      !other.candidate.values.empty() &&
      (fitted.candidate.values.empty() || other.candidate.gain > fitted.candidate.gain);
  const long simulations = fitted.candidate.simulations + other.candidate.simulations;
  if (is_better) fitted = std::move(other);
  fitted.candidate.simulations = simulations;
}

/// The first fit of one effect, values empty where it cannot be simulated.
Fitted fit_first(const Round& round, const RankedTrial& ranked,
                 const std::vector<double>& beginning, int threads) {
  const Hypothesis& h = round.hypotheses[round.evidence.trials[ranked.trial].hypothesis];
  Fitted fitted = keep_fit(
      round, h, round.bench.fit(h, beginning, round.options.screening, {}, threads), beginning);
  fitted.candidate.score = ranked.gain.chi2;
  return fitted;
}

/// A fit far from what the score promised is in another valley, and none of the sizes that a search
/// begins with was in the right one. Near the base the score cannot be wrong, so a fit begins
/// there, if what it promises comes near `most`, the largest gain of all.
void fit_near_base(const Round& round, const RankedTrial& ranked, double most, int threads,
                   Fitted& fitted) {
  constexpr double kSize = 0.02, kKept = 0.5;
  if (!round.data.has_inputs() || ranked.gain.chi2 < kKept * most) return;
  if (!fitted.candidate.values.empty() && fitted.candidate.gain > kKept * ranked.gain.chi2) return;
  const HypothesisTrial& trial = round.evidence.trials[ranked.trial];
  const Hypothesis& h = round.hypotheses[trial.hypothesis];
  const std::vector<double> near =
      scale_beginning(round.data, h, trial, kSize * ranked.gain.amplitude);
  improve(fitted,
          keep_fit(round, h, round.bench.fit(h, near, round.options.screening, {}, threads), near));
  fitted.candidate.score = ranked.gain.chi2;
}

double find_most(const std::vector<Fitted>& fitted) {
  double most = 0.0;
  for (const Fitted& f : fitted) most = std::max(most, f.candidate.gain);
  return most;
}

/// Searches on where a fit has not converged.
void finish(const Round& round, int threads, Fitted& fitted) {
  Candidate& c = fitted.candidate;
  if (c.values.empty()) return;
  const Fitted first = fitted;
  const HypothesisFit fit = round.bench.fit(c.hypothesis, fitted.beginning,
                                            round.options.convergence, fitted.values, threads);
  fitted = keep_fit(round, first.candidate.hypothesis, fit, first.beginning);
  // On a road, a search goes on from where the other unknowns follow, beyond events.
  if (fitted.candidate.values.empty() || fitted.candidate.gain < first.candidate.gain) {
    fitted = first;
  }
  fitted.candidate.score = first.candidate.score;
  fitted.candidate.stability = first.candidate.stability;
  fitted.candidate.simulations = first.candidate.simulations + fit.simulations;
}

/// Whether a candidate's values are within its own effect's range, and such as that effect has; its
/// shapes by their 95 % intervals.
bool is_allowed(const CampaignData& data, const Candidate& c) {
  if (c.values.empty()) return false;
  const std::vector<Unknown> unknowns = make_unknowns(data, c.hypothesis);
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    if (c.values[i] < unknowns[i].low || c.values[i] > unknowns[i].high) return false;
  }
  std::vector<double> low = c.values;
  for (std::size_t i = 0; i < low.size(); ++i) {
    if (!c.hypothesis.parameters[i].switches) low[i] -= kNormal95 * c.sigma[i];
  }
  return is_plausible(data, c.hypothesis, low);
}

/// An effect of the model's file that is better with other values may as well not be there: then
/// that is the hypothesis, since nothing is left to be determined.
void try_removal(const Round& round, int threads, Fitted& fitted) {
  const Candidate& c = fitted.candidate;
  if (c.values.empty() || c.hypothesis.change != EffectChange::kChanged) return;
  const Hypothesis removal = make_removal(round.data, c.hypothesis);
  const std::vector<double>& none = removal.beginnings.front();
  Fitted removed = keep_fit(
      round, removal, round.bench.fit(removal, none, round.options.convergence, {}, threads), none);
  if (removed.candidate.values.empty() ||
      !is_dispensable(round.now.fit, c.gain, removed.candidate.gain)) {
    return;
  }
  removed.candidate.score = c.score;
  removed.candidate.stability = c.stability;
  removed.candidate.simulations += c.simulations;
  fitted = std::move(removed);
}

/// The best of the ranked, and the one that is wanted in any case.
std::vector<RankedTrial> choose(const Evidence& evidence, const std::vector<Hypothesis>& hypotheses,
                                std::vector<RankedTrial> ranked, const RoundOptions& options,
                                double least) {
  std::vector<RankedTrial> chosen;
  for (RankedTrial& r : ranked) {
    const Hypothesis& h = hypotheses[evidence.trials[r.trial].hypothesis];
    const bool is_wanted = options.also != nullptr && is_same_effect(*options.also, h);
    if (is_wanted || (chosen.size() < options.fitted && r.gain.chi2 > least)) {
      chosen.push_back(std::move(r));
    }
  }
  return chosen;
}

std::vector<std::vector<double>> list_beginnings(const Round& round,
                                                 const std::vector<RankedTrial>& ranked,
                                                 const RoundOptions& options) {
  std::vector<std::vector<double>> beginnings;
  for (const RankedTrial& r : ranked) {
    const HypothesisTrial& trial = round.evidence.trials[r.trial];
    const Hypothesis& h = round.hypotheses[trial.hypothesis];
    const bool is_wanted = options.also != nullptr && is_same_effect(*options.also, h) &&
                           options.values.size() == h.parameters.size();
    beginnings.push_back(is_wanted ? options.values : make_beginning(round.data, h, trial, r.gain));
  }
  return beginnings;
}

/// Fits of the ranked: all for a start, then those near the best until they converge, unless the
/// first fit has come near its minimum at less than half of `threshold`.
std::vector<Fitted> fit_ranked(const Round& round, const std::vector<RankedTrial>& ranked,
                               const RoundOptions& options, double threshold) {
  constexpr double kNear = 0.7, kSmall = 0.5;
  const std::vector<std::vector<double>> beginnings = list_beginnings(round, ranked, options);
  const std::vector<std::size_t> twins = find_twins(ranked, beginnings);
  std::vector<Fitted> fitted(ranked.size());
  std::vector<std::size_t> own;
  for (std::size_t i = 0; i < twins.size(); ++i) {
    if (twins[i] == i) own.push_back(i);
  }
  const auto on_each = [&](const auto& work) {
    share_large_items(round.options.threads, own.size(),
                      [&](std::size_t k, int inside) { work(own[k], inside); });
  };
  on_each([&](std::size_t i, int inside) {
    fitted[i] = fit_first(round, ranked[i], beginnings[i], inside);
  });
  const double first = find_most(fitted);
  on_each([&](std::size_t i, int inside) {
    fit_near_base(round, ranked[i], first, inside, fitted[i]);
  });
  const double most = find_most(fitted);
  if (options.is_final) {
    on_each([&](std::size_t i, int inside) {
      const Candidate& c = fitted[i].candidate;
      const bool is_small =
          c.gain < kSmall * threshold && c.distance <= round.options.screening.distance;
      if (!is_small && c.gain > kNear * most && is_allowed(round.data, c)) {
        finish(round, inside, fitted[i]);
      }
      try_removal(round, inside, fitted[i]);
    });
  }
  for (std::size_t i = 0; i < fitted.size(); ++i) {
    if (twins[i] == i) continue;
    const std::size_t h = round.evidence.trials[ranked[i].trial].hypothesis;
    fitted[i].candidate = rename(fitted[twins[i]].candidate, round.hypotheses[h]);
  }
  return fitted;
}

std::vector<bool> list_one_sided(const CampaignData& data,
                                 const std::vector<Hypothesis>& hypotheses) {
  std::vector<bool> one_sided;
  one_sided.reserve(hypotheses.size());
  for (const Hypothesis& h : hypotheses) one_sided.push_back(is_one_sided(data, h));
  return one_sided;
}

}  // namespace

double calc_threshold(const NullScores& nulls, const SelectOptions& options, double negligible) {
  return std::max(options.margin * nulls.get_quantile(options.confidence), negligible);
}

double calc_negligible(bool has_inputs, const SelectOptions& options, const Whitener& whitener) {
  const bool is_known = has_inputs || !whitener.roads().empty();
  const double share = is_known ? options.negligible : options.negligible_car;
  double power = share * static_cast<double>(whitener.whitened_count());
  if (is_known) return power;
  for (std::size_t r = 0; r < whitener.spectra().size(); ++r) {
    const NoiseSpectrum& s = whitener.spectra()[r];
    double ratio = 0.0;  // of the road's power to the sensors', mean over channels
    for (std::size_t c = 0; c < s.sigma.size(); ++c) {
      ratio += s.level * calc_common_variance(s, c) /
               (s.sigma[c] * s.sigma[c] * static_cast<double>(s.sigma.size()));
    }
    const auto count = static_cast<double>(whitener.run_begin()[r + 1] - whitener.run_begin()[r]);
    power += options.negligible_road * ratio * count;
  }
  return power;
}

SelectRound test_effects(const CampaignData& data, const WhitenedFit& now,
                         const SelectOptions& options, const RoundOptions& round_options) {
  TestBench bench(data, now, options.threads);
  const std::vector<Hypothesis> hypotheses = list_hypotheses(data, now.shared());
  const std::vector<bool> one_sided = list_one_sided(data, hypotheses);
  const Evidence evidence = bench.gather(hypotheses);
  const Score score = calc_score(evidence, std::vector<double>(evidence.run_count(), 1.0));
  SelectRound result;
  std::vector<RankedTrial> all = rank_trials(evidence, score, one_sided);
  if (!all.empty()) result.best_score = all.front().gain.chi2;
  NullScores nulls;
  if (round_options.is_final) {
    nulls = draw_null_scores(evidence, score, one_sided, options.nulls);
    result.threshold = calc_threshold(
        nulls, options, calc_negligible(data.has_inputs(), options, bench.whitener()));
  }
  const Round round{data, now, options, bench, hypotheses, evidence};
  const std::vector<RankedTrial> ranked =
      choose(evidence, hypotheses, std::move(all), round_options, 0.3 * result.threshold);
  const std::vector<std::size_t> classes = list_classes(evidence, score, ranked);
  std::vector<Fitted> fitted = fit_ranked(round, ranked, round_options, result.threshold);
  for (std::size_t i = 0; i < fitted.size(); ++i) {
    Candidate& c = fitted[i].candidate;
    result.simulations += c.simulations;
    if (!is_allowed(data, c)) {
      if (!c.values.empty()) result.refused_gain = std::max(result.refused_gain, c.gain);
      continue;
    }
    c.alias = classes[i];
    const std::size_t h = evidence.trials[ranked[i].trial].hypothesis;
    if (round_options.is_final) c.stability = calc_stability(evidence, one_sided, h);
    result.candidates.push_back(std::move(c));
  }
  std::stable_sort(result.candidates.begin(), result.candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.gain > b.gain; });
  const double most = result.candidates.empty() ? 0.0 : result.candidates.front().gain;
  result.misfit = calc_misfit(now.fit, most);
  if (round_options.is_final) {
    result.p_value = nulls.calc_p_value(result.best_score / result.misfit);
    result.undetected =
        list_undetected(evidence, one_sided, now.fit.unknowns, calc_misfit(now.fit, 0.0));
  }
  result.simulations += bench.simulation_count();
  return result;
}

std::vector<Undetected> find_undetected(const CampaignData& data, const WhitenedFit& now,
                                        TestBench& bench) {
  const std::vector<Hypothesis> hypotheses = list_hypotheses(data, now.shared());
  return list_undetected(bench.gather(hypotheses), list_one_sided(data, hypotheses),
                         now.fit.unknowns, calc_misfit(now.fit, 0.0));
}

WhitenedFit adopt(const CampaignData& data, const WhitenedFit& now, const Candidate& candidate) {
  ExtendedUnknowns e =
      extend(data, now, candidate.hypothesis, candidate.base_values, candidate.values);
  WhitenedFit fit;
  fit.runs = now.runs;
  fit.spectra = now.spectra;
  fit.roads = now.roads;
  fit.shared_count = e.shared_count;
  fit.is_dominated = now.is_dominated;
  fit.fit.unknowns = std::move(e.unknowns);
  fit.fit.values = std::move(e.values);
  fit.fit.chi2 = now.fit.chi2 - candidate.gain;
  fit.fit.degrees = now.fit.degrees - static_cast<long>(candidate.values.size());
  return fit;
}

}  // namespace strut
