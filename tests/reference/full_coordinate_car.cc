#include "tests/reference/full_coordinate_car.h"

#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>

namespace strut::reference {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::size_t index_of(int i) { return static_cast<std::size_t>(i); }

/// Jacobian of `rows` for the bodies first .. first + count - 1, the others at rest.
MatrixXd make_jacobian(const std::vector<ConstraintRow>& rows, int first, int count) {
  MatrixXd jacobian = MatrixXd::Zero(static_cast<Index>(rows.size()), 6 * count);
  const auto add = [&](Index row, int body, const Twist6& j) {
    if (body < first || body >= first + count) return;
    jacobian.block<1, 6>(row, 6 * (body - first)) += j.transpose();
  };
  for (std::size_t r = 0; r < rows.size(); ++r) {
    add(static_cast<Index>(r), rows[r].a, rows[r].ja);
    add(static_cast<Index>(r), rows[r].b, rows[r].jb);
  }
  return jacobian;
}

/// Shortest x with J x = right; the second pass recovers what squaring J's condition number loses.
VectorXd solve_shortest(const MatrixXd& jacobian, const VectorXd& right) {
  const Eigen::LDLT<MatrixXd> gram(jacobian * jacobian.transpose());
  VectorXd x = jacobian.transpose() * gram.solve(right);
  x += jacobian.transpose() * gram.solve(right - jacobian * x);
  return x;
}

void displace(const Eigen::Ref<const Twist6>& step, BodyState* body) {
  body->position += step.head<3>();
  const double angle = step.tail<3>().norm();
  if (angle == 0.0) return;
  const Eigen::AngleAxisd turn(angle, step.tail<3>() / angle);
  body->orientation = (Eigen::Quaterniond(turn) * body->orientation).normalized();
}

Eigen::Quaterniond to_rotation(const Eigen::Vector4d& wxyz) {
  return Eigen::Quaterniond(wxyz[0], wxyz[1], wxyz[2], wxyz[3]).normalized();
}

/// Body moving in the chassis, and the chassis in the world.
BodyState carry(const ReducedState& chassis, const BodyState& in_chassis) {
  const Eigen::Quaterniond r = to_rotation(chassis.quaternion);
  const Vector3d& w = chassis.angular_velocity;
  BodyState body;
  body.position = chassis.position + r * in_chassis.position;
  body.orientation = r * in_chassis.orientation;
  body.velocity = r * (chassis.velocity + w.cross(in_chassis.position) + in_chassis.velocity);
  body.angular_velocity = r * (w + in_chassis.angular_velocity);
  return body;
}

/// A rod's spin about its own axis is free and stays what it was; the choice is zero.
void stop_idle_spin(const RigidBody& body, BodyState* state) {
  const Vector3d axis = state->rotate(body.rod_axis);
  state->angular_velocity -= axis.dot(state->angular_velocity) * axis;
}

/// Second derivative of a row's value.
double calc_row_acceleration(const ConstraintRow& row, const std::vector<Twist6>& a) {
  return row.ja.dot(a[index_of(row.a)]) + row.jb.dot(a[index_of(row.b)]) - row.gamma;
}

}  // namespace

FullCoordinateCar::FullCoordinateCar(const VehicleSpec& spec, const ManeuverSpec& maneuver)
    : FullCoordinateCar(
          spec, maneuver,
          make_bump_laws(spec, maneuver, spec.whole.centroid_to_front + maneuver.bump_distance)) {}

FullCoordinateCar::FullCoordinateCar(const VehicleSpec& spec, const ManeuverSpec& maneuver,
                                     ReferenceLaws laws)
    : layout_(make_layout(spec, maneuver.gravity)),
      centroid_height_(spec.whole.centroid_height),
      preload_(spec.preload) {
  forces_.tire = spec.tire;
  forces_.laws = std::move(laws);
  forces_.gravity = maneuver.gravity;
  forces_.drive_torque = maneuver.drive_torque;
  forces_.drive_reaction = maneuver.drive_reaction;
  for (int corner = 0; corner < kCorners; ++corner) {
    const StrutSpec& strut =
        spec.suspension[index_of(axle_of(corner))].strut[is_right(corner) ? 1 : 0];
    forces_.strut[index_of(corner)] = {strut.stiffness, strut.damping, 0.0};
  }
  trim_springs();
  rack_ = spec.rack_position;
}

std::vector<BodyState> FullCoordinateCar::make_nominal_bodies() const {
  std::vector<BodyState> bodies(layout_.bodies.size());
  for (std::size_t k = 0; k < bodies.size(); ++k) bodies[k].position = layout_.centers[k];
  return bodies;
}

ReducedState FullCoordinateCar::make_nominal() const {
  ReducedState reduced;
  reduced.position.z() = centroid_height_;
  return reduced;
}

/// Spring forces that balance the static loads: with the chassis held, no corner accelerates. The
/// corner's acceleration is linear in its spring force.
void FullCoordinateCar::trim_springs() {
  const ReferenceState state = assemble(make_nominal());
  CarForces carried = forces_;
  carried.laws.ground = [](int, double) { return RoadPoint<double>{0.0, 0.0}; };
  carried.frictionless = true;
  carried.drive_torque = 0.0;
  for (CornerStrut& strut : carried.strut) strut = {};
  const std::vector<Wrench> loads = calc_wrenches(carried, layout_, state.bodies);
  std::vector<ConstraintRow> rows = calc_constraints(state);
  for (int i = 0; i < 6; ++i) {
    ConstraintRow hold;
    hold.ja[i] = 1.0;
    rows.push_back(hold);
  }
  for (int corner = 0; corner < kCorners; ++corner) {
    const CornerLayout& c = layout_.corners[index_of(corner)];
    std::vector<ConstraintRow> coordinate;
    add_rows(c.coordinate, state.bodies, &coordinate);
    const auto solve = [&](const std::vector<Wrench>& wrenches) {
      return calc_row_acceleration(
          coordinate[0], solve_accelerations(layout_.bodies, state.bodies, rows, wrenches));
    };
    const LineElement spring = calc_spring(state, corner);
    std::vector<Wrench> unit(layout_.bodies.size());
    add_line_force(spring, 1.0, c.spring_upper, c.spring_lower, state.bodies, &unit);
    const double force = -solve(loads) / solve(unit);
    spring_force_[index_of(corner)] = force;
    CornerStrut& strut = forces_.strut[index_of(corner)];
    strut.free_length = spring.length;
    if (strut.stiffness > 0.0) strut.free_length += force / strut.stiffness;
  }
}

void FullCoordinateCar::set_strut(int corner, const StrutSpec& strut) {
  CornerStrut& own = forces_.strut[index_of(corner)];
  if (preload_ == PreloadKind::kTrimmed) {
    const double force = spring_force_[index_of(corner)];
    own.free_length += force / strut.stiffness - force / own.stiffness;
  }
  own.stiffness = strut.stiffness;
  own.damping = strut.damping;
}

std::vector<Joint> FullCoordinateCar::get_joints(int corner) const {
  const CornerLayout& c = layout_.corners[index_of(corner)];
  std::vector<Joint> joints = c.joints;
  if (c.steered_joint >= 0) joints[index_of(c.steered_joint)].point_a.y() += rack_;
  return joints;
}

void FullCoordinateCar::close_corner(int corner, double q, std::vector<BodyState>* state) const {
  constexpr int kIterations = 60;
  constexpr double kConverged = 1e-10;  // m, rad; the step after it is below the last digit
  constexpr double kLongestStep = 0.2;
  const CornerLayout& c = layout_.corners[index_of(corner)];
  std::vector<Joint> joints = get_joints(corner);
  joints.push_back(c.coordinate);
  joints.back().offset -= q;
  bool converged = false;
  for (int i = 0; i < kIterations; ++i) {
    std::vector<ConstraintRow> rows;
    for (const Joint& joint : joints) add_rows(joint, *state, &rows);
    VectorXd gap(static_cast<Index>(rows.size()));
    for (std::size_t r = 0; r < rows.size(); ++r) gap[static_cast<Index>(r)] = -rows[r].value;
    VectorXd step = solve_shortest(make_jacobian(rows, c.first_body, c.body_count), gap);
    const double size = step.lpNorm<Eigen::Infinity>();
    if (size > kLongestStep) step *= kLongestStep / size;
    for (int k = 0; k < c.body_count; ++k) {
      displace(step.segment<6>(6 * k), &(*state)[index_of(c.first_body + k)]);
    }
    if (converged) return;
    converged = size < kConverged;
  }
  throw std::runtime_error("full-coordinate model: corner " + std::to_string(corner) +
                           " cannot be closed at q = " + std::to_string(q));
}

void FullCoordinateCar::move_corner(int corner, const ReducedState& reduced,
                                    std::vector<BodyState>* state) const {
  const CornerLayout& c = layout_.corners[index_of(corner)];
  std::vector<ConstraintRow> rows;
  for (const Joint& joint : get_joints(corner)) add_rows(joint, *state, &rows);
  const auto closed = static_cast<Index>(rows.size());
  add_rows(c.coordinate, *state, &rows);
  const Vector3d u = (*state)[index_of(c.upright)].rotate(c.spin_axis);
  ConstraintRow spin;
  spin.a = c.wheel;
  spin.b = 0;
  spin.ja.tail<3>() = u;
  rows.push_back(spin);
  VectorXd rates = VectorXd::Zero(closed + 2);
  rates[closed] = reduced.q_dot[index_of(corner)];
  rates[closed + 1] = reduced.spin[index_of(corner)] - u.dot(reduced.angular_velocity);
  const VectorXd twists = solve_shortest(make_jacobian(rows, c.first_body, c.body_count), rates);
  for (int k = 0; k < c.body_count; ++k) {
    BodyState& body = (*state)[index_of(c.first_body + k)];
    body.velocity = twists.segment<3>(6 * k);
    body.angular_velocity = twists.segment<3>(6 * k + 3);
  }
}

ReferenceState FullCoordinateCar::assemble(const ReducedState& reduced,
                                           const ReferenceState* guess) const {
  ReferenceState state;
  state.reduced = reduced;
  state.in_chassis = guess == nullptr ? make_nominal_bodies() : guess->in_chassis;
  for (BodyState& body : state.in_chassis) {
    body.velocity.setZero();
    body.angular_velocity.setZero();
  }
  for (int corner = 0; corner < kCorners; ++corner) {
    close_corner(corner, reduced.q[index_of(corner)], &state.in_chassis);
    move_corner(corner, reduced, &state.in_chassis);
  }
  state.bodies.resize(state.in_chassis.size());
  for (std::size_t k = 0; k < state.bodies.size(); ++k) {
    state.bodies[k] = carry(reduced, state.in_chassis[k]);
    stop_idle_spin(layout_.bodies[k], &state.bodies[k]);
  }
  return state;
}

std::vector<ConstraintRow> FullCoordinateCar::calc_constraints(const ReferenceState& state) const {
  std::vector<ConstraintRow> rows;
  for (int corner = 0; corner < kCorners; ++corner) {
    for (const Joint& joint : get_joints(corner)) add_rows(joint, state.bodies, &rows);
  }
  return rows;
}

std::vector<Twist6> FullCoordinateCar::calc_body_accelerations(const ReferenceState& state) const {
  return solve_accelerations(layout_.bodies, state.bodies, calc_constraints(state),
                             calc_wrenches(forces_, layout_, state.bodies));
}

ReducedAcceleration FullCoordinateCar::calc_accelerations(const ReferenceState& state) const {
  const std::vector<Twist6> a = calc_body_accelerations(state);
  const Eigen::Quaterniond to_chassis = state.bodies[0].orientation.conjugate();
  const Vector3d& w = state.reduced.angular_velocity;
  const Vector3d to_origin = -layout_.centers[0];
  ReducedAcceleration result;
  result.angular = to_chassis * a[0].tail<3>();
  const Vector3d origin =
      to_chassis * a[0].head<3>() + result.angular.cross(to_origin) + w.cross(w.cross(to_origin));
  result.linear = origin - w.cross(state.reduced.velocity);
  for (int corner = 0; corner < kCorners; ++corner) {
    const CornerLayout& c = layout_.corners[index_of(corner)];
    std::vector<ConstraintRow> row;
    add_rows(c.coordinate, state.bodies, &row);
    result.q_ddot[index_of(corner)] = calc_row_acceleration(row[0], a);
    const BodyState& upright = state.bodies[index_of(c.upright)];
    const Vector3d u = upright.rotate(c.spin_axis);
    const Vector3d& wheel_rate = state.bodies[index_of(c.wheel)].angular_velocity;
    result.spin_dot[index_of(corner)] =
        u.dot(a[index_of(c.wheel)].tail<3>()) + wheel_rate.dot(upright.angular_velocity.cross(u));
  }
  return result;
}

CarEnergy FullCoordinateCar::calc_energy(const ReferenceState& state) const {
  CarEnergy energy;
  energy.kinetic = calc_kinetic_energy(layout_.bodies, state.bodies);
  for (std::size_t k = 0; k < state.bodies.size(); ++k) {
    energy.gravity += layout_.bodies[k].mass * forces_.gravity * state.bodies[k].position.z();
  }
  for (int corner = 0; corner < kCorners; ++corner) {
    const CornerStrut& strut = forces_.strut[index_of(corner)];
    const double compression = strut.free_length - calc_spring(state, corner).length;
    energy.springs += 0.5 * strut.stiffness * compression * compression;
  }
  return energy;
}

double FullCoordinateCar::calc_power(const ReferenceState& state) const {
  double power = 0.0;
  for (int corner = 0; corner < kCorners; ++corner) {
    const CornerLayout& c = layout_.corners[index_of(corner)];
    const BodyState& wheel = state.bodies[index_of(c.wheel)];
    const Vector3d& w = wheel.angular_velocity;
    const LineElement damper = calc_damper(state, corner);
    const WheelContact contact = calc_contact(state, corner);
    const Vector3d u = state.bodies[index_of(c.upright)].rotate(c.spin_axis);
    power += damper.force * damper.rate;
    power += contact.force.dot(wheel.velocity + w.cross(contact.point - wheel.position)) +
             contact.moment.dot(w);
    power += c.drive_share * forces_.drive_torque *
             u.dot(w - forces_.drive_reaction * state.bodies[0].angular_velocity);
  }
  return power;
}

WheelContact FullCoordinateCar::calc_contact(const ReferenceState& state, int corner) const {
  return reference::calc_contact(forces_, layout_, corner, state.bodies);
}

LineElement FullCoordinateCar::calc_spring(const ReferenceState& state, int corner) const {
  return reference::calc_spring(forces_, layout_, corner, state.bodies);
}

LineElement FullCoordinateCar::calc_damper(const ReferenceState& state, int corner) const {
  return reference::calc_damper(forces_, layout_, corner, state.bodies);
}

Vector3d FullCoordinateCar::get_wheel_center(const ReferenceState& state, int corner) const {
  return state.bodies[index_of(layout_.corners[index_of(corner)].wheel)].position;
}

Vector3d FullCoordinateCar::get_spin_axis(const ReferenceState& state, int corner) const {
  const CornerLayout& c = layout_.corners[index_of(corner)];
  return state.in_chassis[index_of(c.upright)].rotate(c.spin_axis);
}

}  // namespace strut::reference
