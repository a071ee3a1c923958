// Ranks hypotheses by their scores: the best, their stability without single runs, classes of equal
// responses, and the scores that noise alone gives.
#pragma once

#include <vector>

#include "diagnose/hypothesis/evidence.h"

namespace strut {

/// A trial by its index in Evidence::trials.
struct RankedTrial {
  std::size_t trial;
  Gain gain;
};

/// The best trial of each hypothesis, best first. Trials that are `one_sided`, by hypothesis, have
/// only the sign of their start.
std::vector<RankedTrial> rank_trials(const Evidence& evidence, const Score& score,
                                     const std::vector<bool>& one_sided);

/// Fraction of the runs without each of which the hypothesis has at least 0.8 of the best delta
/// chi2; 1 for a single run.
double calc_stability(const Evidence& evidence, const std::vector<bool>& one_sided,
                      std::size_t hypothesis);

/// The class of each of the ranked: the index of the first whose response is the same, with a
/// cosine of at least 0.995 beside what the free parameters absorb.
std::vector<std::size_t> list_classes(const Evidence& evidence, const Score& score,
                                      const std::vector<RankedTrial>& ranked);

/// The best delta chi2 of all trials in draws from the null hypothesis, ascending.
struct NullScores {
  std::vector<double> best;

  double get_quantile(double confidence) const;
  /// Probability that noise alone scores `score` or more: (1 + number of such draws) / (1 + draws).
  double calc_p_value(double score) const;
};
NullScores draw_null_scores(const Evidence& evidence, const Score& score,
                            const std::vector<bool>& one_sided, std::size_t draws);

}  // namespace strut
