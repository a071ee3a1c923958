// Position of the wheels that trigger the snapshot, from a run's recorded channels.
#pragma once

#include <vector>

#include "model/kernel/simulation.h"

namespace strut {

/// Mean forward position of the rear wheel centers (one-sided bump: of that side) ahead of the
/// bump's center [m], at every history sample of `lane`: x + (R(yaw, pitch, roll) r(q)).x, with the
/// corner coordinate q solved from suspension_deflection on the corner's table and yaw integrated
/// from the gyroscope (trapezoidal; zero on symmetric roads). `results` must hold all car channels.
std::vector<double> calc_line_positions(const PreparedCase& c, const LaneResults& results,
                                        int lane);

}  // namespace strut
