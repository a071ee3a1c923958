// Checks a plan and estimates time and size of its sweep from the first cases.
#pragma once

#include "sweep/plan.h"

namespace strut {

/// Checks, before anything runs, that the model accepts the base case and that the step is stable
/// for it and for the first and last point of the grid. Throws InputError.
void check_plan(const Plan& plan);

struct SweepEstimate {
  int cores = 1;
  int measured = 0;       // cases simulated for the estimate
  int without_event = 0;  // among `measured`: cases that never reach the snapshot's line
  int failed = 0;         // among `measured`: cases without a result for other reasons
  double seconds = 0.0;   // for the whole sweep on all cores
  double bytes = 0.0;     // size of all rows, before compression
};

/// Simulates a batch of the plan's first cases with the plan's settings; with CVODE only the first.
SweepEstimate estimate_sweep(const Plan& plan, const Kernel& kernel);

/// Size of the row of one case [bytes], before compression.
double calc_row_bytes(const ShardSchema& schema);

}  // namespace strut
