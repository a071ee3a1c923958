// `strut simulate` on a rig instead of a car: same files out, no snapshot.
#pragma once

#include "jobs/arguments.h"
#include "jobs/simulate/options.h"
#include "model/vehicle/rigs.h"

namespace strut {

/// Exit code. Throws InputError, EnvironmentError.
int run_rig(const Arguments& arguments, const SimulateOptions& options, RigKind kind);

}  // namespace strut
