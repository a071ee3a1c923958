// What a sweep will take, from a look at its first cases.
#pragma once

#include "sweep/plan.h"

namespace strut {

/// Refuses what can be known before anything runs: a car that the model finds impossible, a step
/// that is too long for the base case or for the first or last point of the grid. Throws
/// InputError.
void check_plan(const Plan& plan);

struct SweepEstimate {
  int cores = 1;
  int measured = 0;       // cases that were simulated for it
  int without_event = 0;  // of those, how many never met the snapshot's line
  int failed = 0;         // of those, how many gave no result otherwise
  double seconds = 0.0;   // on all cores
  double bytes = 0.0;     // of the rows, before compression
};

/// Simulates a batch of the plan's first cases by the plan's settings; by CVODE the first alone.
SweepEstimate estimate_sweep(const Plan& plan, const Kernel& kernel);

/// Bytes of one case's row, before compression.
double calc_row_bytes(const ShardSchema& schema);

}  // namespace strut
