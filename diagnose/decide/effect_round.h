// One round of the selection: a score test of all hypotheses beside a fit, and fits of the best.
#pragma once

#include "diagnose/decide/rank_trials.h"
#include "diagnose/decide/select.h"

namespace strut {

struct RoundOptions {
  std::size_t fitted = 8;            // number of hypotheses fitted, the best by score
  bool is_final = true;              // finds the threshold, and fits the best until they converge
  const Hypothesis* also = nullptr;  // fitted in any case, from `values`
  std::vector<double> values{};
};

/// Threshold of a candidate's delta chi2 over the misfit: that of the null distribution with its
/// margin, at least `negligible`.
double calc_threshold(const NullScores& nulls, const SelectOptions& options, double negligible);

/// chi2 that no cause may claim: a fraction of the power of the noise, of the sensors and the road.
double calc_negligible(bool has_inputs, const SelectOptions& options, const Whitener& whitener);

/// Tests every effect beside those of `now`. Throws InputError where `now` cannot be simulated.
SelectRound test_effects(const CampaignData& data, const WhitenedFit& now,
                         const SelectOptions& options, const RoundOptions& round);

/// Scores every effect beside the fit `now`, with its bench, without fitting any.
std::vector<Undetected> find_undetected(const CampaignData& data, const WhitenedFit& now,
                                        TestBench& bench);

/// The fit `now` with a candidate, at the values that the candidate's own fit found.
WhitenedFit adopt(const CampaignData& data, const WhitenedFit& now, const Candidate& candidate);

}  // namespace strut
