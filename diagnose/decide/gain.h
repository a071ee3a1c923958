// What an extension gains on runs that it was not fitted to.
#pragma once

#include <vector>

#include "diagnose/decide/diagnosis.h"

namespace strut {

/// The runs held out, with the calibrated and the extended model.
std::vector<DiagnosedRun> evaluate_hold_out(const CampaignData& data, const Selection& selection,
                                            int threads);

/// Channel by channel, of the runs of evaluate_hold_out. The noise floor of a channel is what its
/// sensor and, of a car, the roughness that was measured leave of a perfect model.
HoldOutGain calc_hold_out_gain(const CampaignData& data, const Selection& selection,
                               const std::vector<DiagnosedRun>& runs);

}  // namespace strut
