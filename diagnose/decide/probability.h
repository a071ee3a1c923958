// Probabilities of the candidates of a round.
//
// A hypothesis that lets chi2 fall by g has the odds exp(g / (2 t)) against one that lets it stay.
// The temperature t is 1 for effects that look as the catalogue says; real ones differ from it by
// some share of themselves, so gains are not known better than that share of the largest:
//
//   t = 1 + kappa g_best
//
// kappa, and how much must be left for the cause to be none of the catalogue, are fitted to hidden
// trials (docs/design).
#pragma once

#include <vector>

#include "diagnose/decide/select.h"

namespace strut {

struct ProbabilityOptions {
  double form_error = 0.004;  // kappa
  double shape_cost = 1.0;    // ln of the odds against each free shape
  double corner_cost = 1.0;   // ... against one corner of an axle alone
  double group_odds = 3.0;    // ln of the odds within which hypotheses are not told apart
};

/// ln of the odds of each candidate of a round, 0 for the best.
std::vector<double> calc_log_odds(const SelectRound& round, const ProbabilityOptions& options = {});

}  // namespace strut
