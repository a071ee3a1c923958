// The states of a model over which residuals are binned.
#pragma once

#include "diagnose/campaign/campaign_data.h"
#include "estimate/simulate_run.h"

namespace strut {

struct StateCurve {
  const StateInfo* info;
  std::vector<double> values;  // at the run's times; NaN: not simulated
};

/// Lists the curves of ModelInfo::states, in order.
std::vector<StateCurve> list_states(const CampaignData& data, const RunCurves& curves);

}  // namespace strut
