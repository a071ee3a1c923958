// Cars that cross a road, simulated in many variants in lockstep lanes.
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "estimate/linearize_options.h"
#include "estimate/measured_run.h"
#include "estimate/run_prepared.h"
#include "model/car/case.h"

namespace strut {

/// A simulation of run number `run` with another setup. It does not include the effects of the
/// sensors.
struct CrossingTask {
  std::size_t run = 0;
  Case setup;
  /// Longest step [s]; the setup's effects may need a shorter one.
  double longest_step = std::numeric_limits<double>::infinity();
};

/// Samples of a run's compared channels: [MeasuredRun::channels][sample].
using SampledRun = std::vector<std::vector<double>>;

struct CrossingResult {
  std::string failure;         // why it could not be simulated to its end; empty: it was
  bool was_simulated = false;  // also true if the simulation failed on the way
  SampledRun sampled;          // true values, without sensors (read_sensors)
};

/// Simulates the tasks in lanes, with options.rate samples per second. `preparers`: one per run,
/// with the mechanism of the run's first task, its base point. Results do not depend on the number
/// of threads.
std::vector<CrossingResult> simulate_crossings(const std::vector<MeasuredRun>& runs,
                                               const std::vector<CrossingTask>& tasks,
                                               const LinearizeOptions& options,
                                               std::vector<CasePreparer>& preparers);

/// Lists the channels that any of the runs compares, ascending.
std::vector<int> list_recorded(const std::vector<MeasuredRun>& runs);

/// Returns the compared channels of a run from its simulation.
SampledRun get_channels(const MeasuredRun& run, const LaneRun& result);

/// Whether any sensor has effects.
bool has_sensors(const Case& c);

/// Returns the car without the effects of its sensors.
Case remove_sensors(Case c);

/// Applies the effects of the sensors in `setup` to the channels; `interval` s between samples.
SampledRun read_sensors(const Case& setup, const MeasuredRun& run, double interval,
                        SampledRun sampled);

}  // namespace strut
