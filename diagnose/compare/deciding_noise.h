// Verdicts that rest on the estimated noise of a recorded input.
#pragma once

#include <string>
#include <vector>

#include "diagnose/compare/compare.h"

namespace strut {

/// A note for every channel that is adequate in some run by the noise of the inputs, and would not
/// be by its sensor's alone, where an input's noise is estimated and not stated by the campaign.
/// `models`: a model's comparison with each run of the campaign, in its order.
std::vector<std::string> describe_deciding_noise(const CampaignData& data,
                                                 const std::vector<const ModelComparison*>& models);

}  // namespace strut
