// `strut simulate` on a rig instead of a car: same files out, no snapshot.
#pragma once

#include "jobs/case/options.h"
#include "jobs/cli/arguments.h"
#include "model/rig/rigs.h"

namespace strut {

/// Exit code. Throws InputError, EnvironmentError.
int run_rig(const Arguments& arguments, const SimulateOptions& options);

}  // namespace strut
