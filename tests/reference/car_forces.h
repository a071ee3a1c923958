// Applied forces of the full-coordinate car: gravity, springs, dampers, drive torque, tires.
#pragma once

#include "tests/reference/car_layout.h"
#include "tests/reference/reference_laws.h"

namespace strut::reference {

/// One wheel on the road. Vectors in inertial axes.
struct WheelContact {
  double deflection = 0.0;       // m, rho = R0 - loaded radius; negative off the road
  double deflection_rate = 0.0;  // m/s
  double raw_load = 0.0;         // N, spring and damper before the limit to >= 0
  double load = 0.0;             // N, along the road normal
  TireSlip<double> slip{};
  TireForce<double> in_plane{};
  Vector3d point = Vector3d::Zero();   // m, contact point
  Vector3d force = Vector3d::Zero();   // N, on the wheel at the contact point
  Vector3d moment = Vector3d::Zero();  // N m, on the wheel at the contact point
};

/// Spring or damper between two mounts.
struct LineElement {
  double length = 0.0;                    // m
  double rate = 0.0;                      // m/s
  Vector3d direction = Vector3d::Zero();  // unit vector, upper -> lower mount
  double force = 0.0;                     // N, pushes the ends apart
};

/// Spring, damper and free length of one corner.
struct CornerStrut {
  double stiffness = 0.0;    // N/m
  double damping = 0.0;      // N s/m
  double free_length = 0.0;  // m
};

struct CarForces {
  std::array<CornerStrut, kCorners> strut;
  TireContactSpec tire;
  ReferenceLaws laws;
  double gravity = 9.81;        // m/s^2
  double drive_torque = 0.0;    // N m in all
  double drive_reaction = 1.0;  // fraction of it on the chassis
  bool frictionless = false;    // no forces and moments in the plane of the road
};

WheelContact calc_contact(const CarForces& forces, const CarLayout& layout, int corner,
                          const std::vector<BodyState>& state);
LineElement calc_spring(const CarForces& forces, const CarLayout& layout, int corner,
                        const std::vector<BodyState>& state);
LineElement calc_damper(const CarForces& forces, const CarLayout& layout, int corner,
                        const std::vector<BodyState>& state);

/// Adds `force` [N] along the element, pushing its mounts apart.
void add_line_force(const LineElement& element, double force, const MountPoint& upper,
                    const MountPoint& lower, const std::vector<BodyState>& state,
                    std::vector<Wrench>* wrenches);

/// Everything that acts on the bodies but the constraints.
std::vector<Wrench> calc_wrenches(const CarForces& forces, const CarLayout& layout,
                                  const std::vector<BodyState>& state);

}  // namespace strut::reference
