// Cars that cross a road, simulated in many variants in lockstep lanes.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "estimate/linearize_options.h"
#include "estimate/measured_run.h"
#include "model/car/case.h"

namespace strut {

/// A simulation to be made of run number `run`. The sensors' effects are no part of it.
struct CrossingTask {
  std::size_t run = 0;
  Case setup;
};

/// One series by channel of the measured run, sample by sample.
using SampledRun = std::vector<std::vector<double>>;

struct CrossingResult {
  std::string failure;         // reason for which there is no simulation; empty: there is one
  bool was_simulated = false;  // also one that failed on the way
  SampledRun sampled;          // before the sensors (read_sensors)
};

/// Simulates the tasks in lanes, options.rate samples a second. `preparers`: one by run, at the
/// mechanism of the run's base point, which a run's first task sets. No result depends on the
/// number of threads.
std::vector<CrossingResult> simulate_crossings(const std::vector<MeasuredRun>& runs,
                                               const std::vector<CrossingTask>& tasks,
                                               const LinearizeOptions& options,
                                               std::vector<CasePreparer>& preparers);

/// The car without the effects of its sensors.
Case remove_sensors(Case c);

/// The channels as the sensors of `setup` read them; `interval` s between samples.
SampledRun read_sensors(const Case& setup, const MeasuredRun& run, double interval,
                        SampledRun sampled);

}  // namespace strut
