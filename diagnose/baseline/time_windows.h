// The parts of a run by which its residuals are listed.
#pragma once

#include <cstddef>
#include <vector>

#include "diagnose/baseline/residuals.h"
#include "diagnose/campaign/campaign_data.h"

namespace strut {

/// For a car: approach, front axle, between, rear axle, ring-down, by the times at which the wheel
/// centers pass the ends of the bump, half a footprint before and after. For a rig: five equal
/// segments.
std::vector<TimeWindow> make_time_windows(const CampaignData& data, std::size_t run);

}  // namespace strut
