// Improvement of the extended model on held-out runs.
#pragma once

#include <vector>

#include "diagnose/decide/diagnosis.h"

namespace strut {

/// Every run with the nominal, the calibrated and the extended model, judged by the noise of the
/// calibrated one.
std::vector<DiagnosedRun> evaluate_runs(const CampaignData& data, const Diagnosis& diagnosis,
                                        int threads);

/// The improvement by channel over the held-out ones of `runs`. The noise floor of a channel is the
/// residual of a perfect model: noise of the sensor and, for a car, the measured roughness.
Improvement calc_improvement(const CampaignData& data, const Selection& selection,
                             const std::vector<DiagnosedRun>& runs);

/// Whether the held-out runs allow an extension: they become more likely, or less as far as noise
/// explains, and the sum of their channels' excess errors does not grow by more than a twentieth of
/// a floor.
bool is_improved(const Improvement& improvement);

/// Channels of held-out runs that exceed their noise and have become worse by more than a
/// twentieth.
std::vector<std::string> list_worsened(const CampaignData& data,
                                       const std::vector<DiagnosedRun>& runs);

}  // namespace strut
