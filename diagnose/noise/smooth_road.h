// Simulates a car on a road without roughness.
#pragma once

#include "estimate/run_prepared.h"

namespace strut {

/// Simulates with a fit's steps. Throws InputError where the car does not reach the end.
LaneRun simulate_smooth_road(const Case& c, const SamplePlan& plan);

}  // namespace strut
