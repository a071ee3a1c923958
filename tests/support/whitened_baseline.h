// The whitened fit of a campaign's calibrated model, from which a diagnosis starts.
#pragma once

#include "diagnose/noise/whitened_fit.h"

namespace strut::test {

inline WhitenedFit fit_whitened_baseline(const CampaignData& data) {
  const Baseline baseline = calibrate_baseline(data);
  return fit_whitened(data, baseline.runs, {measure_noise(data, baseline, 1)},
                      baseline.fit.unknowns, baseline.fit.values, baseline.shared_count(), 1);
}

}  // namespace strut::test
