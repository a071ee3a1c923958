// The bound on the steps of one simulation.
#pragma once

#include <string>

namespace strut {

/// Why a run of `duration` [s] cannot be integrated by `step` [s]: it would take more than 10^7
/// steps, minutes to hours for each case. Names the shortest step allowed; "" where the run can be.
std::string find_step_count_fault(double duration, double step);

}  // namespace strut
