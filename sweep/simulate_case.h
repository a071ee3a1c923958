// Simulates a single case: what `strut simulate` runs.
#pragma once

#include "sweep/request.h"

namespace strut {

/// Runs a prepared case in plain double on the widest instruction set of this processor, or by
/// CVODE, and reads all channels through their sensors: the snapshot and, if `interval` [s] is
/// above 0, their history. Returns one lane; its `status` is 0 if the run completed, else
/// `failure_time` is when it failed.
LaneResults simulate_case(const PreparedCase& c, const SolverOptions& integrate = {},
                          double interval = 0.0);

/// The same with another plan and kernel. Where a sensor is on, plan.recorded must be empty.
LaneResults simulate_case(const PreparedCase& c, const SolverOptions& integrate,
                          const SamplePlan& plan, const Kernel& kernel = list_kernels().front());

}  // namespace strut
