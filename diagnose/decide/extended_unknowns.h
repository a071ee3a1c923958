// The unknowns of a fit with a hypothesis added to those that all runs share, or removed.
#pragma once

#include <vector>

#include "diagnose/hypothesis/hypothesis.h"
#include "diagnose/noise/whitened_fit.h"

namespace strut {

struct ExtendedUnknowns {
  std::vector<Unknown> unknowns;
  std::vector<double> values;
  std::size_t shared_count = 0;
};

/// Puts the hypothesis behind the shared unknowns of `base`, at these values.
ExtendedUnknowns extend(const CampaignData& data, const WhitenedFit& base, const Hypothesis& h,
                        const std::vector<double>& base_values,
                        const std::vector<double>& parameters);

/// The unknowns of a fit without a hypothesis'.
ExtendedUnknowns remove(const WhitenedFit& fit, const Hypothesis& h);

}  // namespace strut
