// Trim: the equilibrium from which a run starts.
#pragma once

#include "model/car/assemble.h"
#include "model/car/state.h"
#include "model/scenario/maneuver.h"

namespace strut {

struct TrimResult {
  State<double> state;
  std::array<double, kCorners> load;  // N, of each tire
  double residual = 0.0;              // m/s^2, maximum scaled acceleration
};

/// Finds the equilibrium at rest on flat ground, without in-plane tire forces: vertical, roll,
/// pitch and corner accelerations vanish. KINSOL, Newton with line search. Throws ModelError where
/// there is no equilibrium within the travel, as with a spring that cannot carry the car.
TrimResult solve_rest(const Vehicle<double>& vehicle, const VehicleTables<double>& tables,
                      double center_height);

/// Finds steady rolling on flat ground at `speed` [m/s]: as solve_rest, and every wheel turns at
/// constant slip.
TrimResult solve_rolling(const Vehicle<double>& vehicle, const VehicleTables<double>& tables,
                         double center_height, double speed);

}  // namespace strut
