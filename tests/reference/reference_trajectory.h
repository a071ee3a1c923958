// Trajectory of the full-coordinate car by SUNDIALS CVODE.
#pragma once

#include <vector>

#include "tests/reference/full_coordinate_car.h"

namespace strut::reference {

struct TrajectoryOptions {
  double tolerance = 1e-11;  // relative and absolute, of every coordinate and velocity
  int max_steps = 1000000;   // between two samples
};

struct TrajectoryStatistics {
  long evaluations = 0;
  long steps = 0;
  int events = 0;  // wheel lift-offs and landings, kinks of the road
};

/// States at `times` [s], ascending from >= 0, starting from `initial` at t = 0. The integrated
/// variables are the fourteen coordinates and velocities; each evaluation closes the joints by
/// Newton's method and solves the equations with multipliers, so no constraint drifts. CVODE's
/// Adams method stops at every event and starts again after it. Throws std::runtime_error when
/// CVODE fails.
std::vector<ReducedState> integrate(const FullCoordinateCar& car, const ReducedState& initial,
                                    const std::vector<double>& times,
                                    const TrajectoryOptions& options = {},
                                    TrajectoryStatistics* statistics = nullptr);

}  // namespace strut::reference
