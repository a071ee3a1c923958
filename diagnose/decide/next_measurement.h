// Proposes the next measurement: the run in which the hypotheses that the data cannot distinguish
// differ most.
#pragma once

#include <string>
#include <vector>

#include "diagnose/decide/diagnosis.h"

namespace strut {

/// Returns a sentence. With a group: of several possible runs (other speeds and bumps; other
/// amplitudes of a rig) the one in which the best two hypotheses, as fitted to the existing runs,
/// differ most, relative to the sensors' noise. Without a group: a run that would confirm the
/// verdict.
std::string propose_measurement(const CampaignData& data, const Selection& selection,
                                const std::vector<Cause>& group);

}  // namespace strut
