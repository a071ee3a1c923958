// The states of a model against which residuals are looked at.
#pragma once

#include "diagnose/campaign/simulate_run.h"

namespace strut {

struct StateCurve {
  std::string name, unit;
  std::vector<double> values;  // at the run's times; NaN: not simulated
};

/// Of a quarter car suspension deflection, velocity (compression positive) and tire load; of a
/// strut rig displacement and velocity; of a single mass position and velocity; of a car
/// deflection, velocity and tire load of each axle, the mean of its two corners.
std::vector<StateCurve> list_states(const CampaignData& data, const RunCurves& curves);

}  // namespace strut
