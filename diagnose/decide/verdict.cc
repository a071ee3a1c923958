#include "diagnose/decide/verdict.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/error/check.h"
#include "base/math/normal.h"
#include "base/names/name_table.h"
#include "diagnose/decide/probability.h"

namespace strut {
namespace {

constexpr std::array<Named<VerdictKind>, 5> kVerdicts = {
    {{VerdictKind::kAdequate, "adequate"},
     {VerdictKind::kNamed, "named"},
     {VerdictKind::kGroup, "group"},
     {VerdictKind::kFormIncomplete, "form_incomplete"},
     {VerdictKind::kUnknown, "unknown"}}};
static_assert(names_all(kVerdicts, VerdictKind::kUnknown));

constexpr std::array<Named<VerdictKind>, 5> kBadges = {
    {{VerdictKind::kAdequate, "adequate"},
     {VerdictKind::kNamed, "cause"},
     {VerdictKind::kGroup, "group"},
     {VerdictKind::kFormIncomplete, "incomplete"},
     {VerdictKind::kUnknown, "unknown"}}};
static_assert(names_all(kBadges, VerdictKind::kUnknown));

bool is_same(const Hypothesis& a, const Hypothesis& b) {
  return a.effect == b.effect && a.place == b.place && a.change == b.change;
}

CauseParameter make_parameter_of(const ModelInfo& model, const Hypothesis& h, std::size_t i,
                                 double value, double sigma) {
  const auto parameters = list_effect_parameters(*find_effect(h.effect), model);
  const EffectParameter& p = *parameters[i];
  CauseParameter c{p.name, p.unit, value, value - kNormal95 * sigma, value + kNormal95 * sigma};
  c.low = std::clamp(c.low, p.low, std::max(p.low, value));
  c.high = std::clamp(c.high, std::min(p.high, value), p.high);
  c.at_bound = value <= p.low || value >= p.high;
  return c;
}

Cause make_cause(const ModelInfo& model, const Candidate& candidate, double probability) {
  const Hypothesis& h = candidate.hypothesis;
  Cause cause{h.effect, h.place, probability, candidate.gain, {}, h.change, candidate.converged};
  for (std::size_t i = 0; i < candidate.values.size(); ++i) {
    cause.parameters.push_back(
        make_parameter_of(model, h, i, candidate.values[i], candidate.sigma[i]));
  }
  return cause;
}

/// Sets values and intervals of a cause's parameters to those of the extended model's fit.
void set_fitted(const ModelInfo& model, const WhitenedFit& fit, const Hypothesis& h, Cause& cause) {
  for (std::size_t i = 0; i < h.parameters.size(); ++i) {
    for (std::size_t k = 0; k < fit.shared_count; ++k) {
      if (fit.fit.unknowns[k].name != h.parameters[i].name) continue;
      cause.parameters[i] =
          make_parameter_of(model, h, i, fit.fit.values[k], fit.fit.widened.sigma[k]);
    }
  }
}

/// A candidate of a position, before its probability.
struct Entry {
  const Candidate* candidate;
  double odds;
  bool is_chosen;
};

/// The candidates that may take the position of `chosen`: the causes of other positions act
/// already.
std::vector<Entry> list_entries(const SelectRound& round, const Hypothesis& chosen,
                                const std::vector<Hypothesis>& causes) {
  const std::vector<double> odds = calc_log_odds(round);
  std::vector<Entry> entries;
  for (std::size_t i = 0; i < odds.size(); ++i) {
    const Candidate& c = round.candidates[i];
    const bool is_chosen = is_same(c.hypothesis, chosen);
    const bool acts = std::any_of(causes.begin(), causes.end(), [&](const Hypothesis& other) {
      return is_same(c.hypothesis, other);
    });
    if (is_chosen || (c.gain > 0.0 && !acts)) entries.push_back({&c, odds[i], is_chosen});
  }
  std::stable_sort(entries.begin(), entries.end(),
                   [](const Entry& a, const Entry& b) { return a.odds > b.odds; });
  return entries;
}

CausePosition make_position(const ModelInfo& model, const SelectRound& round,
                            const Hypothesis& chosen, const std::vector<Hypothesis>& causes,
                            double unknown) {
  constexpr double kLimitedByForm = 2.0;  // chi2 over its expectation
  const std::vector<Entry> entries = list_entries(round, chosen, causes);
  CausePosition position;
  position.unknown = unknown;
  position.is_limited_by_form = round.misfit > kLimitedByForm;
  double sum = 0.0, own = 0.0;
  for (const Entry& e : entries) {
    sum += std::exp(e.odds - entries.front().odds);
    if (e.is_chosen) own = e.odds;
  }
  position.close = 0;
  for (const Entry& e : entries) {
    if (e.is_chosen) position.chosen = position.candidates.size();
    if (e.odds > own - ProbabilityOptions{}.group_odds) ++position.close;
    position.candidates.push_back(make_cause(
        model, *e.candidate, (1.0 - unknown) * std::exp(e.odds - entries.front().odds) / sum));
  }
  return position;
}

void add_new(const std::vector<Cause>& from, std::size_t begin, std::vector<Cause>& into) {
  for (std::size_t i = begin; i < from.size(); ++i) {
    if (!is_in(into, from[i])) into.push_back(from[i]);
  }
}

std::vector<CausePosition> list_positions(const ModelInfo& model, const Selection& selection,
                                          double unknown) {
  // A cause that was accepted beside others may explain less after these were reconsidered.
  const double least = SelectOptions{}.certain_share;
  const double most = *std::max_element(selection.gains.begin(), selection.gains.end());
  std::vector<CausePosition> positions;
  for (std::size_t i = 0; i < selection.causes.size(); ++i) {
    const Hypothesis& h = selection.causes[i];
    const double share = most > 0.0 ? std::max(selection.gains[i] / most, least) : 1.0;
    const double own = share < 1.0 ? calc_own_probability(share) : 1.0;
    positions.push_back(make_position(model, selection.rounds[selection.round_of[i]], h,
                                      selection.causes, 1.0 - (1.0 - unknown) * own));
    CausePosition& p = positions.back();
    set_fitted(model, selection.extended, h, p.candidates[p.chosen]);
  }
  return positions;
}

bool can_be_claimed(const std::vector<CausePosition>& positions) {
  return std::all_of(positions.begin(), positions.end(),
                     [](const CausePosition& p) { return p.calc_claimed() > p.unknown; });
}

/// The candidates of the first round, where none became a cause.
std::vector<Cause> list_unclaimed(const ModelInfo& model, const Selection& selection) {
  std::vector<Cause> unclaimed;
  if (selection.rounds.empty()) return unclaimed;
  for (const Candidate& c : selection.rounds.front().candidates) {
    if (c.gain > 0.0) unclaimed.push_back(make_cause(model, c, 0.0));
  }
  return unclaimed;
}

}  // namespace

const char* get_name(VerdictKind kind) { return find_name(kVerdicts, kind); }
const char* get_badge(VerdictKind kind) { return find_name(kBadges, kind); }

bool is_same(const Cause& a, const Cause& b) {
  return a.effect == b.effect && a.place == b.place && a.change == b.change;
}

bool is_in(const std::vector<Cause>& causes, const Cause& cause) {
  return std::any_of(causes.begin(), causes.end(),
                     [&](const Cause& other) { return is_same(other, cause); });
}

std::vector<Cause> CausePosition::list_close() const {
  return {candidates.begin(), candidates.begin() + static_cast<std::ptrdiff_t>(close)};
}

double CausePosition::calc_claimed() const {
  double sum = 0.0;
  for (std::size_t i = 0; i < close; ++i) sum += candidates[i].probability;
  return sum;
}

std::vector<Cause> Verdict::list_causes() const {
  std::vector<Cause> causes;
  for (const CausePosition& p : positions) causes.push_back(p.get_cause());
  return causes;
}

std::vector<Cause> Verdict::list_group() const {
  std::vector<Cause> group;
  for (const CausePosition& p : positions) {
    if (p.close > 1) add_new(p.list_close(), 0, group);
  }
  return group;
}

std::vector<Cause> Verdict::list_runners_up() const {
  if (positions.empty()) return rejected;
  std::vector<Cause> claimed = list_causes(), all;
  add_new(list_group(), 0, claimed);
  all = claimed;
  for (const CausePosition& p : positions) add_new(p.candidates, p.close, all);
  return {all.begin() + static_cast<std::ptrdiff_t>(claimed.size()), all.end()};
}

void Verdict::reject(double unknown) {
  rejected = list_causes();
  const std::vector<Cause> others = list_runners_up();
  add_new(list_group(), 0, rejected);
  add_new(others, 0, rejected);
  positions.clear();
  unknown_share = unknown;
}

void Verdict::conclude(bool is_residual_significant, bool has_map) {
  kind = judge({!positions.empty(), !list_group().empty(), has_map, is_residual_significant,
                misfits.empty()});
  if (kind == VerdictKind::kAdequate) {
    unknown_share = 0.0;
    for (Cause& c : rejected) c.probability = 0.0;
  }
  if (kind == VerdictKind::kUnknown && unknown_share == 0.0) unknown_share = 1.0;
}

VerdictKind judge(const VerdictFacts& facts) {
  const bool remains = facts.is_residual_significant || !facts.is_adequate;
  if (!facts.has_causes) {
    return facts.has_map || remains ? VerdictKind::kUnknown : VerdictKind::kAdequate;
  }
  // A map beside the causes is part of their form that the catalogue lacks.
  if (facts.has_map || remains) return VerdictKind::kFormIncomplete;
  return facts.has_group ? VerdictKind::kGroup : VerdictKind::kNamed;
}

double calc_unknown(const Selection& selection, double map_fraction) {
  constexpr double kMin = 0.02, kMiddle = 0.5, kWidth = 0.08;
  if (!selection.is_left) return kMin;
  const double taken = std::accumulate(
      selection.gains.begin(),
      selection.gains.begin() + static_cast<std::ptrdiff_t>(selection.causes.size()), 0.0);
  const double energy = selection.left.energy * (1.0 - std::clamp(map_fraction, 0.0, 1.0));
  const double fraction = taken + energy > 0.0 ? energy / (taken + energy) : 0.0;
  return std::max(kMin, 1.0 / (1.0 + std::exp((kMiddle - fraction) / kWidth)));
}

Verdict make_claim(const ModelInfo& model, const Selection& selection, double map_fraction) {
  Verdict verdict;
  if (selection.causes.empty()) {
    verdict.rejected = list_unclaimed(model, selection);
    return verdict;
  }
  verdict.unknown_share = calc_unknown(selection, map_fraction);
  verdict.positions = list_positions(model, selection, verdict.unknown_share);
  if (!can_be_claimed(verdict.positions)) verdict.reject(verdict.unknown_share);
  return verdict;
}

void check_verdict(const Verdict& verdict, bool has_map) {
  for (const CausePosition& p : verdict.positions) {
    STRUT_CHECK(p.chosen < p.close && p.close <= p.candidates.size(), "an empty position");
    double sum = p.unknown;
    for (const Cause& c : p.candidates) {
      STRUT_CHECK(c.probability >= 0.0 && c.probability <= 1.0, c.effect + ": no probability");
      sum += c.probability;
    }
    STRUT_CHECK(std::abs(sum - 1.0) < 1e-9, "the probabilities of a position do not sum to 1");
    STRUT_CHECK(p.calc_claimed() > p.unknown, "a claim is less probable than none");
  }
  const VerdictKind kind = verdict.kind;
  const bool is_claim = kind != VerdictKind::kAdequate && kind != VerdictKind::kUnknown;
  STRUT_CHECK(verdict.positions.empty() != is_claim, "the kind contradicts the claim");
  STRUT_CHECK((verdict.unknown_share > 0.0) == (kind != VerdictKind::kAdequate),
              "the kind contradicts the probability of an unknown cause");
  if (kind == VerdictKind::kFormIncomplete || kind == VerdictKind::kUnknown) return;
  STRUT_CHECK(verdict.misfits.empty() && !has_map, "a complete verdict leaves a misfit");
  STRUT_CHECK(verdict.list_group().empty() == (kind != VerdictKind::kGroup),
              "the kind contradicts the group");
}

}  // namespace strut
