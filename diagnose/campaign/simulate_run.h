// One run of a campaign as the model has it: every channel at the times of the readings.
#pragma once

#include "diagnose/campaign/campaign_data.h"

namespace strut {

struct RunCurves {
  std::string failure;                       // empty: it got through
  std::vector<std::vector<double>> channel;  // [channel of the model][time]; NaN: not simulated
};

/// At `values` of `unknowns`, of which those with Unknown::run kEveryRun or 0 are this run's;
/// biases are added to the channels they belong to.
RunCurves simulate_run(const CampaignData& data, std::size_t run,
                       const std::vector<Unknown>& unknowns, const std::vector<double>& values);

/// As the model's file and the campaign have it.
RunCurves simulate_nominal(const CampaignData& data, std::size_t run);

}  // namespace strut
