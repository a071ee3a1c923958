// Limits the number of steps of one simulation.
#pragma once

#include <string>

namespace strut {

/// Returns the error message if a run of `duration` [s] by `step` [s] takes more than 10^7 steps
/// (minutes to hours per case), else "". The message names the minimum step.
std::string find_step_count_fault(double duration, double step);

}  // namespace strut
