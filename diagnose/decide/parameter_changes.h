// The model's own parameters before and after the extension.
#pragma once

#include <vector>

#include "diagnose/decide/diagnosis.h"

namespace strut {

/// Returns the parameters that all runs share but for errors of sensors, in the order of their
/// unknowns, with 95 % intervals that are widened by the misfit. Those of the final model, the
/// extended or else the calibrated one, contain those of all close candidates, and allow for
/// undetected effects and for a residual of unknown form (undetected.h).
std::vector<ParameterChange> list_parameter_changes(const CampaignData& data,
                                                    const Diagnosis& diagnosis);

}  // namespace strut
