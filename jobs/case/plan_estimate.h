// Checks a plan and estimates time and size of its sweep from the first cases.
#pragma once

#include <string>
#include <vector>

#include "sweep/plan.h"

namespace strut {

/// Checks, before anything runs, that the model accepts the base case and that the step is stable
/// for it and for the first and last point of the grid. Throws InputError.
void check_plan(const Plan& plan);

struct SweepEstimate {
  int cores = 1;                   // of this machine, all of which measured at once
  int measured = 0;                // cases simulated for the estimate
  int without_event = 0;           // among `measured`: cases that never reach the snapshot's line
  int failed = 0;                  // among `measured`: cases without a result for other reasons
  std::int64_t first_failed = -1;  // the first of them
  std::string first_reason;        // and why it failed
  double core_seconds = 0.0;       // processor time of the whole sweep
  double bytes = 0.0;              // of all shards' files

  double seconds() const { return core_seconds / cores; }
};

/// Simulates the plan's first cases with the plan's settings on all cores, at least a batch on each
/// and some 0.2 s, and compresses their rows.
SweepEstimate estimate_sweep(const Plan& plan, const Kernel& kernel);

/// A case that the model rejects, and why.
struct ImpossibleCase {
  std::int64_t case_id = 0;
  std::string axis;  // that is at its other end
  std::string reason;
};

/// The points of a grid with one axis at its other end that the model rejects; none of samples.
std::vector<ImpossibleCase> find_impossible_ends(const Plan& plan);

/// "1.2 core-hours"; seconds below 0.1 core-hours.
std::string describe_core_seconds(double core_seconds);

/// Size of the row of one case [bytes], before compression.
double calc_row_bytes(const ShardSchema& schema);

}  // namespace strut
