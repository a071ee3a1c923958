// The stretches of a run that its residuals are looked at by.
#pragma once

#include <cstddef>
#include <vector>

#include "diagnose/baseline/residuals.h"
#include "diagnose/campaign/campaign_data.h"

namespace strut {

/// A car's run: approach, front axle, between, rear axle, ring-down, by when its wheel centers pass
/// the ends of the bump, a footprint's length before and after; a rig's: five equal segments.
std::vector<TimeWindow> make_time_windows(const CampaignData& data, std::size_t run);

}  // namespace strut
