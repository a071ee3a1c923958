// The state a run starts from.
#pragma once

#include "model/car/assemble.h"
#include "model/car/state.h"
#include "model/scenario/maneuver.h"

namespace strut {

/// What a trim found.
struct TrimResult {
  State<double> state;
  std::array<double, kCorners> load;  // N, of each tire
  double residual = 0.0;              // m/s^2, largest relative acceleration left
};

/// At rest on flat ground, tires without in-plane force: vertical, roll, pitch and corner
/// accelerations vanish. Throws ModelError if the car finds no equilibrium within its travel (a
/// spring that cannot carry it). KINSOL, Newton with line search.
TrimResult solve_rest(const Vehicle<double>& vehicle, const VehicleTables<double>& tables,
                      double center_height);

/// Steadily rolling on flat ground at `speed`: as at rest, and every wheel turns at constant slip.
TrimResult solve_rolling(const Vehicle<double>& vehicle, const VehicleTables<double>& tables,
                         double center_height, double speed);

}  // namespace strut
