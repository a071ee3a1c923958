// The model's own parameters before and after the extension.
#pragma once

#include <vector>

#include "diagnose/decide/diagnosis.h"

namespace strut {

/// The parameters that all runs share but for errors of sensors, in the order of their unknowns,
/// with 95 % intervals that are widened by the misfit; after the extension, with those of all close
/// candidates.
std::vector<ParameterChange> list_parameter_changes(const CampaignData& data,
                                                    const Selection& selection,
                                                    const std::vector<CausePosition>& positions);

}  // namespace strut
