// The whole car in maximal coordinates with Lagrange multipliers: an independent truth.
//
// Shares no dynamics code with the model it checks. Bodies and joints: car_layout.h; equations:
// rigid_bodies.h; forces: car_forces.h. See README.md in this folder for the conventions.
#pragma once

#include <Eigen/Dense>
#include <array>
#include <cstddef>
#include <vector>

#include "model/car/spec.h"
#include "model/scenario/maneuver.h"
#include "tests/reference/car_forces.h"
#include "tests/reference/car_layout.h"

namespace strut::reference {

/// Values that determine the car's motion. The chassis point is the whole car's centroid at nominal
/// trim.
struct ReducedState {
  Vector3d position = Vector3d::Zero();                   // m, world
  Eigen::Vector4d quaternion = Eigen::Vector4d::Unit(0);  // w x y z, chassis -> world
  Vector3d velocity = Vector3d::Zero();                   // m/s, chassis axes
  Vector3d angular_velocity = Vector3d::Zero();           // rad/s, chassis axes
  /// Front: strut shortening; rear: rise of the wheel center along chassis z [m].
  std::array<double, kCorners> q{};
  std::array<double, kCorners> q_dot{};  // m/s
  std::array<double, kCorners> spin{};   // rad/s, inertial spin of the wheel about its axis
};

/// Rates of the velocities of `ReducedState`.
struct ReducedAcceleration {
  Vector3d linear = Vector3d::Zero();     // m/s^2, rate of the chassis-axes components of velocity
  Vector3d angular = Vector3d::Zero();    // rad/s^2, chassis axes
  std::array<double, kCorners> q_ddot{};  // m/s^2
  std::array<double, kCorners> spin_dot{};  // rad/s^2
};

/// A state of all bodies that satisfies the constraints and their rates.
struct ReferenceState {
  ReducedState reduced;
  std::vector<BodyState> bodies;      // world axes
  std::vector<BodyState> in_chassis;  // positions relative to the chassis origin, chassis axes
};

struct CarEnergy {
  double kinetic = 0.0, gravity = 0.0, springs = 0.0;  // J

  double total() const { return kinetic + gravity + springs; }
};

class FullCoordinateCar {
 public:
  /// Bump centered at world x = centroid_to_front + bump_distance: the chassis starts at x = 0.
  FullCoordinateCar(const VehicleSpec& spec, const ManeuverSpec& maneuver);
  FullCoordinateCar(const VehicleSpec& spec, const ManeuverSpec& maneuver, ReferenceLaws laws);

  /// Positions by Newton's method on the constraints from nominal trim, or from `guess`; throws
  /// std::runtime_error where the joints cannot be closed.
  ReferenceState assemble(const ReducedState& reduced, const ReferenceState* guess = nullptr) const;

  ReducedAcceleration calc_accelerations(const ReferenceState& state) const;
  std::vector<Twist6> calc_body_accelerations(const ReferenceState& state) const;

  CarEnergy calc_energy(const ReferenceState& state) const;
  /// Power of what has no potential here: dampers, tires (vertical too), drive torque [W].
  /// d(total energy)/dt equals it.
  double calc_power(const ReferenceState& state) const;

  WheelContact calc_contact(const ReferenceState& state, int corner) const;
  LineElement calc_spring(const ReferenceState& state, int corner) const;
  LineElement calc_damper(const ReferenceState& state, int corner) const;
  Vector3d get_wheel_center(const ReferenceState& state, int corner) const;
  /// Spin axis of the wheel in chassis axes, to the left.
  Vector3d get_spin_axis(const ReferenceState& state, int corner) const;

  /// Constraint equations of the whole car at this state; values and rates should be zero.
  std::vector<ConstraintRow> calc_constraints(const ReferenceState& state) const;

  /// State at nominal trim, at rest, at world x = y = 0.
  ReducedState make_nominal() const;

  /// Changes one corner's spring and damper, as a grid does. The free length stays (the corner
  /// sags) or, if the specification says kTrimmed, is found anew.
  void set_strut(int corner, const StrutSpec& strut);
  /// Overrides the free length found at nominal trim [m].
  void set_free_length(int corner, double length) {
    forces_.strut[static_cast<std::size_t>(corner)].free_length = length;
  }
  void set_frictionless(bool frictionless) { forces_.frictionless = frictionless; }
  void set_drive_torque(double torque) { forces_.drive_torque = torque; }

  const CarLayout& layout() const { return layout_; }
  const CarForces& forces() const { return forces_; }

 private:
  std::vector<BodyState> make_nominal_bodies() const;
  void trim_springs();
  void close_corner(int corner, double q, std::vector<BodyState>* state) const;
  void move_corner(int corner, const ReducedState& reduced, std::vector<BodyState>* state) const;
  std::vector<Joint> get_joints(int corner) const;

  CarLayout layout_;
  CarForces forces_;
  double centroid_height_ = 0.0;  // m
  double rack_ = 0.0;             // m
  PreloadKind preload_ = PreloadKind::kFreeLength;
  std::array<double, kCorners> spring_force_{};  // N at nominal trim
};

}  // namespace strut::reference
