// Improvement of the extended model on held-out runs.
#pragma once

#include <vector>

#include "diagnose/decide/diagnosis.h"

namespace strut {

/// The held-out runs with the calibrated and the extended model.
std::vector<DiagnosedRun> evaluate_hold_out(const CampaignData& data, const Selection& selection,
                                            int threads);

/// The improvement by channel over the runs of evaluate_hold_out. The noise floor of a channel is
/// the residual of a perfect model: noise of the sensor and, for a car, the measured roughness.
Improvement calc_improvement(const CampaignData& data, const Selection& selection,
                             const std::vector<DiagnosedRun>& runs);

}  // namespace strut
