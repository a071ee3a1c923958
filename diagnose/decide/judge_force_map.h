// Rules by which the held-out runs accept a force map.
#pragma once

#include <vector>

#include "diagnose/decide/fit_force_map.h"

namespace strut {

/// Sums over the held-out runs under one model.
struct HoldOutSum {
  bool is_whole = true;  // all runs were simulated
  double chi2 = 0.0, log_likelihood = 0.0, expected = 0.0;

  explicit HoldOutSum(const std::vector<HoldOutRun>& runs);
  /// chi2 over its expectation, at least 1: each reading counts as so many times less.
  double calc_misfit() const;
  /// Log odds of this model against another.
  double calc_log_odds(const HoldOutSum& other) const;
};

/// Fraction of the excess over noise of `now` that `judged` removes, at most 1: where noise happens
/// to be small, more than all of it is removed.
double calc_removed_share(const HoldOutSum& now, const HoldOutSum& judged);

/// Whether the held-out runs confirm a map: by their odds, and by the excess that it removes.
bool is_map_confirmed(const HoldOutSum& now, const HoldOutSum& judged,
                      const ForceMapOptions& options);

/// Whether a map without the causes removes so much that they may be an imitation of it: `before`
/// without extension, `now` with the causes, `judged` with the map instead.
bool explains_causes(const HoldOutSum& before, const HoldOutSum& now, const HoldOutSum& judged,
                     const ForceMapOptions& options);

}  // namespace strut
