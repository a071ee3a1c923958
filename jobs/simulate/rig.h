// `strut simulate` on a rig: writes the same files as for a car, prints no snapshot.
#pragma once

#include "jobs/cli/arguments.h"
#include "jobs/simulate/options.h"
#include "model/rig/rigs.h"

namespace strut {

/// Simulates and writes the output. Returns an exit code. Throws InputError, EnvironmentError.
int run_rig(const Arguments& arguments, const SimulateOptions& options);

}  // namespace strut
