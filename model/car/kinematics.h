// What a suspension does to its wheel over its travel, with the chassis held.
#pragma once

#include <vector>

#include "model/car/assemble.h"

namespace strut {

/// A corner's wheel at one travel. Chassis axes: x forward, y left, z up.
struct KinematicsPoint {
  double travel = 0.0;          // m, vertical displacement of the wheel center from nominal trim
  double camber = 0.0;          // rad, + top outwards
  double toe = 0.0;             // rad, + toe-in
  Vec3<double> displacement{};  // m, of the wheel center from nominal trim
  double caster_change = 0.0;   // rad, side-view turn of the upright's z axis, + top rearwards
  double spring_length = 0.0;   // m, between its mounts
  double damper_length = 0.0;   // m
  double track = 0.0;           // m, of the axle when both wheels travel alike
};

/// A corner of `car` at wheel travels [m] in ascending order, each solved by Newton from its
/// neighbor nearer to nominal trim, to 1e-13 m; neighbors should lie within some 5 mm. Travels may
/// exceed kHalfTravel a little. Throws ModelError, naming axle and travel, where the loops do not
/// close.
std::vector<KinematicsPoint> calc_kinematics(const AssembledVehicle& car, int corner,
                                             const std::vector<double>& travels);

}  // namespace strut
