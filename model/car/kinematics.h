// Kinematics of a suspension: the wheel over its travel, with the chassis fixed.
#pragma once

#include <vector>

#include "model/car/assemble.h"

namespace strut {

/// State of a corner's wheel at one travel. Chassis axes: x forward, y left, z up.
struct KinematicsPoint {
  double travel = 0.0;          // m, vertical displacement of the wheel center from nominal trim
  double camber = 0.0;          // rad, + top outwards
  double toe = 0.0;             // rad, + toe-in
  Vec3<double> displacement{};  // m, of the wheel center from nominal trim
  double caster_change = 0.0;   // rad, side-view turn of the upright's z axis, + top rearwards
  double spring_length = 0.0;   // m, between its mounts
  double damper_length = 0.0;   // m
  double track = 0.0;           // m, of the axle when both wheels have this travel
};

/// Kinematics of a corner of `car` at wheel travels [m] in ascending order, each by Newton from the
/// neighbor nearer to nominal trim, to 1e-13 m; neighbors should be at most about 5 mm apart.
/// Travels may slightly exceed kHalfTravel. Throws ModelError with axle and travel where the loops
/// do not close.
std::vector<KinematicsPoint> calc_kinematics(const AssembledVehicle& car, int corner,
                                             const std::vector<double>& travels);

}  // namespace strut
