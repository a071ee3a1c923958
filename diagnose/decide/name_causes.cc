#include "diagnose/decide/name_causes.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/math/normal.h"
#include "diagnose/decide/probability.h"

namespace strut {
namespace {

bool is_same(const Hypothesis& h, const std::string& effect, const std::string& place) {
  return h.effect == effect && h.place == place;
}

CauseParameter make_parameter_of(const CampaignData& data, const Hypothesis& h, std::size_t i,
                                 double value, double sigma) {
  const auto parameters = list_effect_parameters(*find_effect(h.effect), data.model());
  const EffectParameter& p = *parameters[i];
  CauseParameter c{p.name, p.unit, value, value - kNormal95 * sigma, value + kNormal95 * sigma};
  c.low = std::clamp(c.low, p.low, std::max(p.low, value));
  c.high = std::clamp(c.high, std::min(p.high, value), p.high);
  return c;
}

Cause make_cause(const CampaignData& data, const Candidate& candidate, double probability) {
  Cause cause{
      candidate.hypothesis.effect, candidate.hypothesis.place, probability, candidate.gain, {}};
  cause.change = candidate.hypothesis.change;
  cause.converged = candidate.converged;
  for (std::size_t i = 0; i < candidate.values.size(); ++i) {
    cause.parameters.push_back(
        make_parameter_of(data, candidate.hypothesis, i, candidate.values[i], candidate.sigma[i]));
  }
  return cause;
}

/// Sets values and intervals of a cause's parameters to those of the extended model's fit.
void set_fitted(const CampaignData& data, const WhitenedFit& fit, const Hypothesis& h,
                Cause& cause) {
  cause.parameters.clear();
  for (std::size_t i = 0; i < h.parameters.size(); ++i) {
    for (std::size_t k = 0; k < fit.shared_count; ++k) {
      if (fit.fit.unknowns[k].name != h.parameters[i].name) continue;
      cause.parameters.push_back(
          make_parameter_of(data, h, i, fit.fit.values[k], fit.fit.widened.sigma[k]));
    }
  }
}

/// Adds the candidates of one round with their probabilities to causes, group and runners-up.
/// `unknown`: probability of a cause outside of the catalogue.
void add_round(const CampaignData& data, const SelectRound& round, const Hypothesis& chosen,
               double unknown, Diagnosis& diagnosis) {
  const ProbabilityOptions options;
  const std::vector<double> odds = calc_log_odds(round, options);
  double sum = 0.0, own = 0.0;
  for (std::size_t i = 0; i < odds.size(); ++i) {
    if (round.candidates[i].gain <= 0.0) continue;
    sum += std::exp(odds[i]);
    if (is_same(round.candidates[i].hypothesis, chosen.effect, chosen.place)) own = odds[i];
  }
  std::vector<Cause> close;
  for (std::size_t i = 0; i < odds.size(); ++i) {
    const Candidate& c = round.candidates[i];
    if (c.gain <= 0.0) continue;
    Cause cause = make_cause(data, c, (1.0 - unknown) * std::exp(odds[i]) / sum);
    const bool is_chosen = is_same(c.hypothesis, chosen.effect, chosen.place);
    if (odds[i] > own - options.group_odds) {
      close.push_back(cause);
    } else if (!is_chosen) {
      diagnosis.runners_up.push_back(cause);
    }
    if (is_chosen) diagnosis.causes.push_back(std::move(cause));
  }
  std::stable_sort(close.begin(), close.end(),
                   [](const Cause& a, const Cause& b) { return a.probability > b.probability; });
  if (close.size() > 1) {
    diagnosis.group.insert(diagnosis.group.end(), close.begin(), close.end());
  }
}

/// Drops runners-up that are a cause or in the group of another round, or listed twice.
void drop_repeated(Diagnosis& diagnosis) {
  std::vector<Cause> kept;
  for (Cause& c : diagnosis.runners_up) {
    if (is_in(diagnosis.causes, c) || is_in(diagnosis.group, c) || is_in(kept, c)) continue;
    kept.push_back(std::move(c));
  }
  diagnosis.runners_up = std::move(kept);
}

/// Probability that the cause is none of the catalogue. A cause of another form leaves a fraction
/// of itself as residual; a larger residual has another cause.
double calc_unknown(const Selection& selection) {
  constexpr double kMin = 0.02, kMiddle = 0.5, kWidth = 0.08;
  if (!selection.is_left) return kMin;
  const double taken = std::accumulate(
      selection.gains.begin(),
      selection.gains.begin() + static_cast<std::ptrdiff_t>(selection.causes.size()), 0.0);
  const double energy = selection.left.energy;
  const double fraction = taken + energy > 0.0 ? energy / (taken + energy) : 0.0;
  return std::max(kMin, 1.0 / (1.0 + std::exp((kMiddle - fraction) / kWidth)));
}

void judge_without_causes(const CampaignData& data, Diagnosis& diagnosis) {
  const Selection& selection = diagnosis.selection;
  diagnosis.kind = selection.is_left ? VerdictKind::kUnknown : VerdictKind::kAdequate;
  diagnosis.unknown_share = selection.is_left ? 1.0 : 0.0;
  for (const Candidate& c : selection.rounds.front().candidates) {
    if (selection.is_left && c.gain > 0.0) {
      diagnosis.runners_up.push_back(make_cause(data, c, 0.0));
    }
  }
}

VerdictKind judge_causes(const Diagnosis& diagnosis) {
  if (!diagnosis.selection.is_left) {
    return diagnosis.group.empty() ? VerdictKind::kNamed : VerdictKind::kGroup;
  }
  // With a map beside them that removes most of the remaining residual, the causes keep their
  // names.
  const bool is_named = diagnosis.force && diagnosis.force->fraction > 0.5;
  return diagnosis.unknown_share > 0.5 && !is_named ? VerdictKind::kUnknown
                                                    : VerdictKind::kFormIncomplete;
}

}  // namespace

void name_causes(const CampaignData& data, Diagnosis& diagnosis) {
  const Selection& selection = diagnosis.selection;
  if (selection.causes.empty()) {
    judge_without_causes(data, diagnosis);
    return;
  }
  diagnosis.unknown_share = calc_unknown(selection);
  for (std::size_t i = 0; i < selection.causes.size(); ++i) {
    add_round(data, selection.rounds[selection.round_of[i]], selection.causes[i],
              diagnosis.unknown_share, diagnosis);
  }
  drop_repeated(diagnosis);
  for (Cause& cause : diagnosis.causes) {
    for (const Hypothesis& h : selection.causes) {
      if (is_same(h, cause.effect, cause.place)) set_fitted(data, selection.extended, h, cause);
    }
  }
  diagnosis.kind = judge_causes(diagnosis);
}

}  // namespace strut
