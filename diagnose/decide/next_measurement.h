// What to measure next: the run in which the hypotheses that the data cannot tell apart differ
// most.
#pragma once

#include <string>
#include <vector>

#include "diagnose/decide/diagnosis.h"

namespace strut {

/// A sentence. Each hypothesis of the group is taken as fitted to the runs there are, and every
/// item of a menu (other speeds and bumps; other amplitudes of a rig) is simulated with both of the
/// best two: the larger their difference over the sensors' noise, the better. Without a group: what
/// would make the verdict surer.
std::string propose_measurement(const CampaignData& data, const Selection& selection,
                                const std::vector<Cause>& group);

}  // namespace strut
