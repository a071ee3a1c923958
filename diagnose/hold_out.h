// Runs that were kept apart, as the judge of a model.
#pragma once

#include <string>
#include <vector>

#include "diagnose/whitener.h"

namespace strut {

struct HoldOutRun {
  std::size_t run = 0;  // of the campaign
  std::string failure;  // empty: it could be simulated
  double chi2 = 0.0;    // whitened, and of the priors
  double log_likelihood = 0.0;
  std::size_t count = 0;  // of whitened readings
};

/// Each run that is held out at these shared values, what is unknown about it alone fitted to it.
/// `level`: of roughness, of cars.
std::vector<HoldOutRun> judge_hold_out(const CampaignData& data, const SharedValues& shared,
                                       double level, int threads = 1);

}  // namespace strut
