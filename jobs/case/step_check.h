// Whether the steps that the user chose are short enough for the car, before anything runs.
#pragma once

#include <optional>
#include <string>

#include "base/error/input_error.h"
#include "jobs/case/options.h"

namespace strut {

/// Why a step is too long: "each step multiplies ...", "must lie in (0, 0.004] s here".
struct StepFault {
  std::string how, allowed;
};

/// Nothing where the map of `step` [s] amplifies no disturbance of the case's start.
std::optional<StepFault> find_step_fault(const PreparedCase& c, IntegrateOptions integrate,
                                         double step);

/// The message for the unstable step of option `name`, "--step": `how` it shows, what is `allowed`.
InputError make_step_error(const SimulateOptions& options, const char* name, double step,
                           const std::string& how, const std::string& allowed);

/// Refuses --step and --coarse-step whose map amplifies disturbances; cvode has none. Throws
/// InputError.
void check_steps(const PreparedCase& c, const SimulateOptions& options);

}  // namespace strut
