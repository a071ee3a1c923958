// Proposes the next measurement: the run in which the hypotheses that the data cannot distinguish
// differ most.
#pragma once

#include <string>
#include <vector>

#include "diagnose/decide/diagnosis.h"

namespace strut {

/// Returns a sentence. With a group: the possible run (possible_runs.h) that separates the best two
/// hypotheses most, if by at least 3 standard deviations (separation.h); none where the existing
/// runs should do so. Without a group: a run that would confirm the verdict.
std::string propose_measurement(const CampaignData& data, const Selection& selection,
                                const std::vector<Cause>& group);

}  // namespace strut
