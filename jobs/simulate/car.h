// `strut simulate` on a car.
#pragma once

#include "jobs/cli/arguments.h"
#include "jobs/simulate/options.h"

namespace strut {

/// Simulates, writes the output and prints the snapshot. Returns an exit code. Throws InputError,
/// EnvironmentError.
int run_car(const Arguments& arguments, const SimulateOptions& options);

}  // namespace strut
