// Free rigid bodies held together by constraint equations: the textbook form of a mechanism.
//
// Every body has its own position and orientation; a joint is a set of scalar equations between two
// bodies. Newton-Euler with Lagrange multipliers,
//   [ M  J^T ] [ acceleration ]   [ forces - gyroscopic terms ]
//   [ J   0  ] [ -multipliers ] = [ gamma                     ],   J acceleration = gamma,
// gives the accelerations. Nothing here knows of cars, trees or independent coordinates.
#pragma once

#include <Eigen/Dense>
#include <vector>

namespace strut::reference {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Twist6 = Eigen::Matrix<double, 6, 1>;  // [velocity of the center of mass ; angular velocity]

/// Constant properties; the body axes have their origin at the center of mass.
struct RigidBody {
  double mass = 0.0;                     // kg, > 0
  Matrix3d inertia = Matrix3d::Zero();   // kg m^2, body axes, about the center of mass
  Vector3d rod_axis = Vector3d::Zero();  // unit vector of a rod that spins idly, else zero
};

/// Motion of one body, all vectors in the common (inertial) axes.
struct BodyState {
  Vector3d position = Vector3d::Zero();                             // m, center of mass
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  // body axes -> inertial axes
  Vector3d velocity = Vector3d::Zero();                             // m/s
  Vector3d angular_velocity = Vector3d::Zero();                     // rad/s

  Vector3d rotate(const Vector3d& in_body_axes) const { return orientation * in_body_axes; }
  Vector3d point(const Vector3d& s) const { return position + rotate(s); }
  Vector3d point_velocity(const Vector3d& s) const {
    return velocity + angular_velocity.cross(rotate(s));
  }
};

enum class JointKind {
  kCoincident,     // 3 equations: point_a - point_b = 0
  kPerpendicular,  // 1 equation: axis_a . axis_b = 0
  kProjection,     // 1 equation: axis_a . (point_b - point_a) + offset = 0
};

/// Constraint between bodies a and b; points from the center of mass and axes in body axes.
struct Joint {
  JointKind kind = JointKind::kCoincident;
  int a = 0, b = 0;
  Vector3d point_a = Vector3d::Zero(), point_b = Vector3d::Zero();
  Vector3d axis_a = Vector3d::Zero(), axis_b = Vector3d::Zero();
  double offset = 0.0;
};

/// One scalar equation: value(positions), rate = ja . V_a + jb . V_b, and second derivative
/// ja . A_a + jb . A_b - gamma.
struct ConstraintRow {
  int a = 0, b = 0;
  Twist6 ja = Twist6::Zero(), jb = Twist6::Zero();
  double value = 0.0;
  double gamma = 0.0;
};

/// Force and moment about the center of mass on each body [N, N m].
struct Wrench {
  Vector3d force = Vector3d::Zero();
  Vector3d moment = Vector3d::Zero();
};

Joint make_coincident(int a, int b, const Vector3d& point_a, const Vector3d& point_b);
Joint make_perpendicular(int a, int b, const Vector3d& axis_a, const Vector3d& axis_b);
Joint make_projection(int a, int b, const Vector3d& axis_a, const Vector3d& point_a,
                      const Vector3d& point_b, double offset);

/// Appends the equations of one joint.
void add_rows(const Joint& joint, const std::vector<BodyState>& state,
              std::vector<ConstraintRow>* rows);

/// Adds `force` acting at the body point `s` (body axes, from the center of mass).
void add_force_at(const BodyState& state, const Vector3d& s, const Vector3d& force, Wrench* wrench);

/// Accelerations [dv/dt ; dw/dt] of every body, inertial axes, from the sparse system above with
/// one step of iterative refinement. Throws std::runtime_error if the constraints are dependent.
std::vector<Twist6> solve_accelerations(const std::vector<RigidBody>& bodies,
                                        const std::vector<BodyState>& state,
                                        const std::vector<ConstraintRow>& rows,
                                        const std::vector<Wrench>& wrenches);

/// Sum of m v^2/2 + w.J w/2 [J].
double calc_kinetic_energy(const std::vector<RigidBody>& bodies,
                           const std::vector<BodyState>& state);

/// Inertia about the center of mass in inertial axes.
Matrix3d rotate_inertia(const RigidBody& body, const BodyState& state);

}  // namespace strut::reference
