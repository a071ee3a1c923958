// Simulates one measured run at the times of the readings.
#pragma once

#include <string>
#include <vector>

#include "estimate/unknown.h"

namespace strut {

struct RunCurves {
  std::string failure;  // empty: simulated to its end
  /// [channel of the model][time]; NaN: not simulated; without times: not asked for.
  std::vector<std::vector<double>> channel;
};

/// Simulates `run` with the unknowns that all runs share or that belong to run 0 set to `values`,
/// and adds the biases to their channels. Throws InputError where a value is out of its range.
RunCurves simulate_run(const MeasuredRun& run, const std::vector<Unknown>& unknowns,
                       const std::vector<double>& values);

/// simulate_run with ideal sensors: the motion itself, not what sensors read of it.
RunCurves simulate_motion(const MeasuredRun& run, const std::vector<Unknown>& unknowns,
                          const std::vector<double>& values);

/// simulate_run at each of several points, in the processor's lanes, with the run's compared
/// channels only. A point that fails affects no other; throws as simulate_run.
std::vector<RunCurves> simulate_points(const MeasuredRun& run, const std::vector<Unknown>& unknowns,
                                       const std::vector<std::vector<double>>& points);

}  // namespace strut
