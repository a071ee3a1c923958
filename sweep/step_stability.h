// Whether an integration step is short enough for a case.
#pragma once

#include <optional>
#include <string>

#include "model/kernel/simulation.h"

namespace strut {

/// Why a step is unstable, and which steps are allowed.
struct StepFault {
  std::string reason;   // "each step multiplies a disturbance by 1.3"
  std::string allowed;  // "must lie in (0, 0.004] s here"
};

/// Returns a fault if integrating `c` with `step` [s] amplifies disturbances of its start state by
/// more than kMaxAmplification a step.
std::optional<StepFault> find_step_fault(const PreparedCase& c, IntegrateOptions integrate,
                                         double step);

}  // namespace strut
