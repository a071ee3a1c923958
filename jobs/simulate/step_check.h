// Refuses integration steps that are too long for the car, before anything runs.
#pragma once

#include <string>

#include "base/error/input_error.h"
#include "jobs/simulate/options.h"

namespace strut {

/// The error for an unstable `step` [s] of the option `name` ("--step"). `reason`: the evidence;
/// `allowed`: the steps that are, or that were found to work.
InputError make_step_error(const SimulateOptions& options, const char* name, double step,
                           const std::string& reason, const std::string& allowed);

/// Refuses unstable --step and --coarse-step; cvode has neither. Throws InputError.
void check_steps(const PreparedCase& c, const SimulateOptions& options);

}  // namespace strut
