#include "diagnose/decide/select.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "base/error/input_error.h"
#include "base/math/normal.h"
#include "base/parallel/team.h"

namespace strut {
namespace {

bool is_one_sided(const CampaignData& data, const Hypothesis& h) {
  const auto parameters = list_effect_parameters(*find_effect(h.effect), data.model());
  return std::any_of(parameters.begin(), parameters.end(),
                     [](const EffectParameter* p) { return p->switches && p->low >= p->neutral; });
}

struct RankedTrial {
  std::size_t trial;
  Gain gain;
};

/// The best trial of each hypothesis, best first.
std::vector<RankedTrial> rank(const Evidence& evidence, const Score& score,
                              const std::vector<bool>& one_sided) {
  std::map<std::size_t, RankedTrial> best;
  for (std::size_t t = 0; t < evidence.trials.size(); ++t) {
    const HypothesisTrial& trial = evidence.trials[t];
    const Gain gain = calc_gain(score, trial.columns, one_sided[trial.hypothesis]);
    const auto found = best.find(trial.hypothesis);
    if (found != best.end() && found->second.gain.chi2 >= gain.chi2) continue;
    best[trial.hypothesis] = {t, gain};
  }
  std::vector<RankedTrial> list;
  list.reserve(best.size());
  for (const auto& [hypothesis, ranked] : best) list.push_back(ranked);
  std::stable_sort(list.begin(), list.end(), [](const RankedTrial& a, const RankedTrial& b) {
    return a.gain.chi2 > b.gain.chi2;
  });
  return list;
}

/// A beginning with the sizes that the score asks for, within what is allowed.
std::vector<double> make_beginning(const CampaignData& data, const Hypothesis& h,
                                   const HypothesisTrial& trial, const Gain& gain) {
  const auto parameters = list_effect_parameters(*find_effect(h.effect), data.model());
  std::vector<double> values = h.beginnings[trial.beginning];
  for (std::size_t j = 0; j < trial.parameters.size(); ++j) {
    const std::size_t i = trial.parameters[j];
    // Not too far: what is linear at first may not stay so.
    const double amplitude = std::clamp(gain.amplitude(static_cast<Eigen::Index>(j)), -10.0, 10.0);
    values[i] = std::clamp(values[i] * amplitude, parameters[i]->low, parameters[i]->high);
  }
  return values;
}

/// A beginning with a fiftieth of its sizes.
std::vector<double> reduce(const HypothesisTrial& trial, std::vector<double> beginning) {
  constexpr double kShare = 0.02;
  for (const std::size_t i : trial.parameters) beginning[i] *= kShare;
  return beginning;
}

std::vector<double> make_weights(std::size_t count) { return std::vector<double>(count, 1.0); }

/// Share of the runs without which the hypothesis is still within a factor of the best.
double calc_stability(const Evidence& evidence, const std::vector<bool>& one_sided,
                      std::size_t hypothesis) {
  constexpr double kStays = 0.8;
  if (evidence.run_count() < 2) return 1.0;
  double stays = 0.0;
  for (std::size_t r = 0; r < evidence.run_count(); ++r) {
    std::vector<double> weights = make_weights(evidence.run_count());
    weights[r] = 0.0;
    const Score score = calc_score(evidence, weights);
    const std::vector<RankedTrial> ranked = rank(evidence, score, one_sided);
    const auto own = std::find_if(ranked.begin(), ranked.end(), [&](const RankedTrial& t) {
      return evidence.trials[t.trial].hypothesis == hypothesis;
    });
    if (own != ranked.end() && own->gain.chi2 >= kStays * ranked.front().gain.chi2) ++stays;
  }
  return stays / static_cast<double>(evidence.run_count());
}

/// The unknowns and values of a fit with a hypothesis put behind those that all runs share.
struct ExtendedUnknowns {
  std::vector<Unknown> unknowns;
  std::vector<double> values;
  std::size_t shared_count = 0;
};

ExtendedUnknowns extend(const CampaignData& data, const WhitenedFit& base, const Hypothesis& h,
                        const std::vector<double>& base_values,
                        const std::vector<double>& parameters) {
  ExtendedUnknowns e;
  const auto shared = static_cast<std::ptrdiff_t>(base.shared_count);
  e.unknowns.assign(base.fit.unknowns.begin(), base.fit.unknowns.begin() + shared);
  e.values.assign(base_values.begin(), base_values.begin() + shared);
  std::vector<Unknown> own = make_unknowns(data, h);
  const auto of_effect = list_effect_parameters(*find_effect(h.effect), data.model());
  for (std::size_t i = 0; i < own.size(); ++i) {
    Unknown& u = own[i];
    // Steps and sizes are counted in what was found.
    if (parameters[i] != 0.0) u.scale = std::abs(parameters[i]);
    if (!h.parameters[i].switches) {
      const double ordinary = std::max(std::abs(parameters[i]), std::abs(of_effect[i]->typical));
      u.prior = {parameters[i], std::max(ordinary, 1e-12)};
    }
    e.unknowns.push_back(std::move(u));
    e.values.push_back(parameters[i]);
  }
  e.shared_count = e.unknowns.size();
  e.unknowns.insert(e.unknowns.end(), base.fit.unknowns.begin() + shared, base.fit.unknowns.end());
  e.values.insert(e.values.end(), base_values.begin() + shared, base_values.end());
  return e;
}

/// The same without a hypothesis.
ExtendedUnknowns remove(const WhitenedFit& fit, const Hypothesis& h) {
  ExtendedUnknowns e;
  for (std::size_t i = 0; i < fit.fit.unknowns.size(); ++i) {
    const auto is_own = [&](const HypothesisParameter& p) {
      return p.name == fit.fit.unknowns[i].name;
    };
    if (std::any_of(h.parameters.begin(), h.parameters.end(), is_own)) continue;
    e.unknowns.push_back(fit.fit.unknowns[i]);
    e.values.push_back(fit.fit.values[i]);
    if (i < fit.shared_count) ++e.shared_count;
  }
  return e;
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

double sum_chi2(const std::vector<HoldOutRun>& runs) {
  double sum = 0.0;
  for (const HoldOutRun& run : runs) sum += run.failure.empty() ? run.chi2 : 1e300;
  return sum;
}

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
    const std::vector<NoiseSpectrum> spectra = measure_noise(data_, baseline);
    selection_.base = fit_excited(baseline, spectra);
    selection_.extended = selection_.base;
    tell("judging the runs held out");
    selection_.judge =
        std::make_shared<const HoldOutJudge>(data_, selection_.base, options_.threads);
    selection_.hold_out_before = judge(selection_.base);
    selection_.hold_out_after = selection_.hold_out_before;
    const int most =
        selection_.base.is_dominated ? options_.most_causes_dominated : options_.most_causes;
    while (static_cast<int>(selection_.causes.size()) < most && add()) {
    }
    if (selection_.causes.size() > 1) reconsider();
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
    return fit_whitened(data_, runs, chosen, unknowns, values, baseline.shared_count(),
                        options_.threads);
  }

  void tell(const std::string& what) const {
    if (options_.progress) options_.progress(what);
  }

  std::vector<HoldOutRun> judge(const WhitenedFit& fit) const {
    return selection_.judge->judge(fit.shared());
  }

  /// chi2 that no cause may claim: a share of the noise's power, sensors' and road's.
  double calc_negligible(const Whitener& whitener) const {
    const double share = data_.has_inputs() ? options_.negligible : options_.negligible_car;
    double power = share * static_cast<double>(whitener.whitened_count());
    if (data_.has_inputs()) return power;
    for (std::size_t r = 0; r < whitener.spectra().size(); ++r) {
      const NoiseSpectrum& s = whitener.spectra()[r];
      double ratio = 0.0;  // of the road's power to the sensors', mean over channels
      for (std::size_t c = 0; c < s.sigma.size(); ++c) {
        ratio += s.level * calc_common_variance(s, c) /
                 (s.sigma[c] * s.sigma[c] * static_cast<double>(s.sigma.size()));
      }
      const auto count = static_cast<double>(whitener.run_begin()[r + 1] - whitener.run_begin()[r]);
      power += options_.negligible_road * ratio * count;
    }
    return power;
  }

  void measure_left() {
    const WhitenedFit& now = selection_.extended;
    TestBench bench(data_, now, options_.threads);
    selection_.left = measure_leftover(data_, bench, options_.leftover);
    selection_.simulations += bench.simulation_count();
    selection_.is_left = selection_.left.significance >= options_.leftover.significant;
    // A round's best that was large but explains too little for a cause of its own is left, too.
    const SelectRound& last = selection_.rounds.back();
    if (!last.candidates.empty() && !last.accepted && !selection_.causes.empty() &&
        last.candidates.front().gain / last.misfit > 2.0 * last.threshold) {
      selection_.is_left = true;
      selection_.left.energy = std::max(selection_.left.energy, last.candidates.front().gain);
    }
  }

  /// With several causes, the first were chosen without the others: each is taken out, everything
  /// tested anew, and replaced where another does better, or left out where nothing does.
  void reconsider() {
    // What replaces a cause stands last; another one then stands in its place.
    std::size_t i = 0;
    for (std::size_t left = selection_.causes.size() - 1;
         left > 0 && i + 1 < selection_.causes.size(); --left) {
      const Selection kept = selection_;
      const Hypothesis removed = selection_.causes[i];
      const ExtendedUnknowns e = remove(selection_.extended, removed);
      selection_.causes.erase(selection_.causes.begin() + static_cast<std::ptrdiff_t>(i));
      selection_.round_of.erase(selection_.round_of.begin() + static_cast<std::ptrdiff_t>(i));
      selection_.gains.erase(selection_.gains.begin() + static_cast<std::ptrdiff_t>(i));
      tell("reconsidering " + removed.describe());
      selection_.extended = fit_whitened(data_, kept.extended.runs, kept.extended.spectra,
                                         e.unknowns, e.values, e.shared_count, options_.threads);
      selection_.hold_out_after = judge(selection_.extended);
      const bool added = add();
      const bool same = added && selection_.causes.back().effect == removed.effect &&
                        selection_.causes.back().place == removed.place;
      const bool better = sum_chi2(selection_.hold_out_after) < sum_chi2(kept.hold_out_after);
      if (!same && better) continue;
      const long simulations = selection_.simulations;
      selection_ = kept;
      selection_.simulations = simulations;
      ++i;
    }
  }

  /// The fit of one effect, values empty where it cannot be simulated.
  Candidate fit_candidate(const TestBench& bench, const Hypothesis& h, const HypothesisTrial& trial,
                          const Gain& gain, const std::vector<double>& beginning) const {
    HypothesisFit fit = bench.fit(h, beginning);
    Candidate c;
    c.simulations = fit.simulations;
    if (data_.has_inputs() && (!fit.failure.empty() || fit.gain < 0.5 * gain.chi2)) {
      // Far from what the score promised: another valley, and none of the sizes that a search
      // begins with was in the right one. Near the base the score cannot be wrong.
      HypothesisFit near = bench.fit(h, reduce(trial, beginning));
      c.simulations += near.simulations;
      if (near.failure.empty() && (!fit.failure.empty() || near.gain > fit.gain)) {
        fit = std::move(near);
      }
    }
    c.hypothesis = h;
    c.score = gain.chi2;
    c.gain = fit.gain;
    c.sigma = fit.sigma;
    if (!fit.failure.empty()) return c;
    const auto base = static_cast<std::ptrdiff_t>(bench.values().size());
    c.base_values.assign(fit.values.begin(), fit.values.begin() + base);
    c.values.assign(fit.values.begin() + base, fit.values.end());
    c.shared = make_shared(selection_.extended, h, fit);
    return c;
  }

  /// One round; whether a cause was added.
  bool add() {
    const WhitenedFit& now = selection_.extended;
    tell("testing every effect" +
         (selection_.causes.empty() ? "" : " beside " + selection_.causes.back().describe()));
    TestBench bench(data_, now, options_.threads);
    const SharedValues shared = now.shared();
    const std::vector<Hypothesis> hypotheses =
        list_hypotheses(data_, shared, list_effects_on(data_, shared), shared.unknowns);
    std::vector<bool> one_sided;
    one_sided.reserve(hypotheses.size());
    for (const Hypothesis& h : hypotheses) one_sided.push_back(is_one_sided(data_, h));
    const Evidence evidence = bench.gather(hypotheses);
    const Score score = calc_score(evidence, make_weights(evidence.run_count()));
    SelectRound round;
    round.threshold =
        std::max(options_.margin * calc_null_threshold(evidence, score, one_sided, options_.nulls,
                                                       options_.confidence),
                 calc_negligible(bench.whitener()));
    std::vector<RankedTrial> ranked = rank(evidence, score, one_sided);
    ranked.resize(std::min(ranked.size(), options_.fitted));
    std::erase_if(ranked,
                  [&](const RankedTrial& r) { return r.gain.chi2 < 0.3 * round.threshold; });
    tell("fitting the best " + std::to_string(ranked.size()));
    // Each alone on a thread: one fit does not fill several.
    std::vector<std::vector<double>> beginnings;
    for (const RankedTrial& r : ranked) {
      const HypothesisTrial& trial = evidence.trials[r.trial];
      beginnings.push_back(make_beginning(data_, hypotheses[trial.hypothesis], trial, r.gain));
    }
    const std::vector<std::size_t> twins = find_twins(ranked, beginnings);
    std::vector<Candidate> fitted(ranked.size());
    share_items(options_.threads, ranked.size(), [&](std::size_t i, int /*thread*/) {
      if (twins[i] != i) return;
      const HypothesisTrial& trial = evidence.trials[ranked[i].trial];
      fitted[i] =
          fit_candidate(bench, hypotheses[trial.hypothesis], trial, ranked[i].gain, beginnings[i]);
      fitted[i].stability = calc_stability(evidence, one_sided, trial.hypothesis);
    });
    for (std::size_t i = 0; i < fitted.size(); ++i) {
      if (twins[i] == i) continue;
      const std::size_t h = evidence.trials[ranked[i].trial].hypothesis;
      fitted[i] = rename(fitted[twins[i]], hypotheses[h]);
    }
    for (Candidate& c : fitted) {
      selection_.simulations += c.simulations;
      if (c.values.empty() || !is_allowed(c)) continue;
      round.candidates.push_back(std::move(c));
    }
    std::stable_sort(round.candidates.begin(), round.candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.gain > b.gain; });
    const double most = round.candidates.empty() ? 0.0 : round.candidates.front().gain;
    round.misfit = std::max(1.0, (now.fit.chi2 - most) / static_cast<double>(now.fit.degrees));
    selection_.simulations += bench.simulation_count();
    selection_.rounds.push_back(std::move(round));
    const bool accepted = accept(selection_.rounds.back());
    selection_.rounds.back().accepted = accepted;
    return accepted;
  }

  /// Whether a candidate's values are within its own effect's range, and such as that effect has.
  bool is_allowed(const Candidate& c) const {
    const std::vector<Unknown> unknowns = make_unknowns(data_, c.hypothesis);
    for (std::size_t i = 0; i < unknowns.size(); ++i) {
      if (c.values[i] < unknowns[i].low || c.values[i] > unknowns[i].high) return false;
    }
    return is_plausible(data_, c.hypothesis, c.values);
  }

  /// Whether the best of a round gains far more than it needs.
  bool is_certain(const SelectRound& round) const {
    return round.candidates.front().gain > options_.certain * round.threshold * round.misfit;
  }

  /// Whether the best of a round is large enough to be fitted in full.
  bool is_large(const SelectRound& round) const {
    if (round.candidates.empty()) return false;
    const WhitenedFit& now = selection_.extended;
    const double gain = round.candidates.front().gain;
    if (now.is_dominated) return gain > options_.dominated_share * now.fit.chi2;
    if (gain / round.misfit < round.threshold) return false;
    if (!is_certain(round) && round.candidates.front().stability < options_.stability) return false;
    const double first = selection_.rounds.front().candidates.front().gain;
    return selection_.rounds.size() == 1 || gain > options_.second_share * first;
  }

  bool accept(const SelectRound& round) {
    if (!is_large(round)) return false;
    const Candidate& best = round.candidates.front();
    const ExtendedUnknowns e =
        extend(data_, selection_.extended, best.hypothesis, best.base_values, best.values);
    tell("fitting with " + best.hypothesis.describe());
    const bool was_dominated = selection_.extended.is_dominated;
    WhitenedFit fit = fit_whitened(data_, selection_.extended.runs, selection_.extended.spectra,
                                   e.unknowns, e.values, e.shared_count, options_.threads);
    std::vector<HoldOutRun> judged = judge(fit);
    const double before = sum_chi2(selection_.hold_out_after), after = sum_chi2(judged);
    double wanted = 0.5 * options_.dominated_share * before;
    if (!was_dominated) {
      double readings = 0.0;
      for (const HoldOutRun& run : judged) readings += run.expected;
      wanted = is_certain(round) ? 0.0
                                 : options_.hold_out_share * best.gain * readings /
                                       static_cast<double>(selection_.extended.fit.degrees);
    }
    if (before - after <= wanted) return false;
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
};

}  // namespace

double calc_null_threshold(const Evidence& evidence, const Score& score,
                           const std::vector<bool>& one_sided, std::size_t nulls,
                           double confidence) {
  constexpr std::uint64_t kSeed = 1;
  // Of correlations: effects differ in size by orders, and rounding of the largest is not to be
  // taken for noise of the smallest.
  const Eigen::VectorXd sigma = score.covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  const Eigen::VectorXd unit = sigma.unaryExpr([](double s) { return s > 0.0 ? 1.0 / s : 0.0; });
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(unit.asDiagonal() * score.covariance *
                                                              unit.asDiagonal());
  const Eigen::MatrixXd root = sigma.asDiagonal() * solver.eigenvectors() *
                               solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  std::vector<double> most;
  most.reserve(nulls);
  Score null = score;
  for (std::size_t i = 0; i < nulls; ++i) {
    Eigen::VectorXd normal(root.cols());
    for (Eigen::Index k = 0; k < normal.size(); ++k) {
      normal(k) = calc_normal(kSeed, i, static_cast<std::uint64_t>(k));
    }
    null.gradient = root * normal;
    double best = 0.0;
    for (const HypothesisTrial& trial : evidence.trials) {
      best = std::max(best, calc_gain(null, trial.columns, one_sided[trial.hypothesis]).chi2);
    }
    most.push_back(best);
  }
  std::sort(most.begin(), most.end());
  return most[std::min(nulls - 1,
                       static_cast<std::size_t>(confidence * static_cast<double>(nulls)))];
}

Selection select_causes(const CampaignData& data, const SelectOptions& options) {
  return Selector(data, options).run();
}

}  // namespace strut
