// One run of a rig.
#pragma once

#include "model/kernel/simulation.h"
#include "python/core/settings.h"

namespace strut {

/// Runs the rig under its inputs as `strut simulate` does; the history has all channels, every
/// `interval` [s]. Throws InputError for a setting that only cars have, ModelError for a missing,
/// unknown or invalid input.
LaneResults simulate_rig_run(const RigSpec& rig, const RigManeuver& maneuver,
                             const IntegrationWords& words, double interval);

}  // namespace strut
