// From a vehicle's description to free bodies and the joints between them.
//
// Every moving part is a body: chassis; front lower arm, strut rod (if it has mass), upright, wheel
// and tie rod; rear upright, wheel and five links. Body axes equal the chassis axes at nominal
// trim, so a vector of the specification is a vector in body axes.
#pragma once

#include <array>
#include <vector>

#include "model/car/spec.h"
#include "tests/reference/rigid_bodies.h"

namespace strut::reference {

/// Point fixed to a body, from its center of mass in body axes [m].
struct MountPoint {
  int body = 0;
  Vector3d s = Vector3d::Zero();
};

struct CornerLayout {
  int first_body = 0, body_count = 0;  // consecutive in CarLayout::bodies
  int upright = 0, wheel = 0;
  std::vector<Joint> joints;
  Joint coordinate;        // projection equal to q: strut shortening or rise of the wheel center
  int steered_joint = -1;  // joint whose chassis point moves with the rack, -1: none
  Vector3d spin_axis = Vector3d::UnitY();    // in body axes of upright and wheel, to the left
  Vector3d wheel_center = Vector3d::Zero();  // m, chassis axes at nominal trim
  MountPoint spring_upper, spring_lower, damper_upper, damper_lower;
  double drive_share = 0.0;  // fraction of the whole torque
  double static_load = 0.0;  // N
};

struct CarLayout {
  std::vector<RigidBody> bodies;  // [0] is the chassis
  std::vector<Vector3d> centers;  // m, centers of mass at nominal trim, chassis axes
  std::array<CornerLayout, kCorners> corners;
};

/// Chassis axes have their origin at the whole car's centroid at nominal trim. The chassis gets the
/// mass, center of mass and inertia that the whole car lacks without it; wheels stand at the height
/// that carries the static axle loads on flat ground.
/// Throws std::invalid_argument for massless moving parts and for an impossible chassis.
CarLayout make_layout(const VehicleSpec& spec, double gravity);

}  // namespace strut::reference
