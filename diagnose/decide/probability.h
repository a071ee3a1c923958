// Probabilities of the candidates of a round.
//
// A hypothesis with the delta chi2 g has the odds exp(g / (2 t)) against the model without it. The
// temperature t is 1 if effects have exactly the form of the catalogue; real ones deviate by a
// fraction of themselves, which limits the accuracy of every delta chi2 to that fraction of the
// largest:
//
//   t = 1 + kappa g_best
//
// kappa, and the residual above which the cause is none of the catalogue, are fitted to hidden
// trials (docs/design).
#pragma once

#include <vector>

#include "diagnose/decide/select.h"

namespace strut {

struct ProbabilityOptions {
  double form_error = 0.004;  // kappa
  double shape_cost = 1.0;    // log odds against each free shape parameter
  double corner_cost = 1.0;   // log odds against a single corner of an axle
  double group_odds = 3.0;    // log odds within which hypotheses are indistinguishable
};

/// Probability that a cause which explains `share` of what the largest does is one of its own, and
/// not what the largest lacks in form: share / (share + 0.03). In hidden trials half of the causes
/// with shares around 0.03 were right.
double calc_own_probability(double share);

/// Log odds of each candidate of a round relative to the best.
std::vector<double> calc_log_odds(const SelectRound& round, const ProbabilityOptions& options = {});

}  // namespace strut
