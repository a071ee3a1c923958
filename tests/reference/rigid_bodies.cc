#include "tests/reference/rigid_bodies.h"

#include <Eigen/SparseLU>
#include <cstddef>
#include <stdexcept>

namespace strut::reference {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using Triplets = std::vector<Eigen::Triplet<double>>;

const BodyState& at(const std::vector<BodyState>& state, int body) {
  return state[static_cast<std::size_t>(body)];
}

Twist6 stack(const Vector3d& linear, const Vector3d& angular) {
  Twist6 t;
  t << linear, angular;
  return t;
}

/// w x (w x r)
Vector3d centripetal(const Vector3d& w, const Vector3d& r) { return w.cross(w.cross(r)); }

void add_coincident(const Joint& joint, const BodyState& a, const BodyState& b,
                    std::vector<ConstraintRow>* rows) {
  const Vector3d sa = a.rotate(joint.point_a), sb = b.rotate(joint.point_b);
  const Vector3d gap = (a.position - b.position) + (sa - sb);
  const Vector3d drift = centripetal(a.angular_velocity, sa) - centripetal(b.angular_velocity, sb);
  for (int i = 0; i < 3; ++i) {
    const Vector3d e = Vector3d::Unit(i);
    rows->push_back(
        {joint.a, joint.b, stack(e, sa.cross(e)), stack(-e, -sb.cross(e)), gap[i], -drift[i]});
  }
}

void add_perpendicular(const Joint& joint, const BodyState& a, const BodyState& b,
                       std::vector<ConstraintRow>* rows) {
  const Vector3d ua = a.rotate(joint.axis_a), ub = b.rotate(joint.axis_b);
  const Vector3d n = ua.cross(ub);
  const Vector3d n_dot =
      a.angular_velocity.cross(ua).cross(ub) + ua.cross(b.angular_velocity.cross(ub));
  const Vector3d zero = Vector3d::Zero();
  rows->push_back({joint.a, joint.b, stack(zero, n), stack(zero, -n), ua.dot(ub),
                   -(a.angular_velocity - b.angular_velocity).dot(n_dot)});
}

void add_projection(const Joint& joint, const BodyState& a, const BodyState& b,
                    std::vector<ConstraintRow>* rows) {
  const Vector3d sa = a.rotate(joint.point_a), sb = b.rotate(joint.point_b);
  const Vector3d u = a.rotate(joint.axis_a);
  const Vector3d& wa = a.angular_velocity;
  const Vector3d& wb = b.angular_velocity;
  const Vector3d d = (b.position - a.position) + (sb - sa);
  const Vector3d d_dot = (b.velocity - a.velocity) + wb.cross(sb) - wa.cross(sa);
  const double drift = centripetal(wa, u).dot(d) + 2.0 * wa.cross(u).dot(d_dot) +
                       u.dot(centripetal(wb, sb) - centripetal(wa, sa));
  rows->push_back({joint.a, joint.b, stack(-u, u.cross(d) - sa.cross(u)), stack(u, sb.cross(u)),
                   u.dot(d) + joint.offset, -drift});
}

void add_block(Index row, Index column, const Matrix3d& block, Triplets* triplets) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) triplets->emplace_back(row + i, column + j, block(i, j));
  }
}

void add_symmetric(Index row, Index column, const Twist6& entries, Triplets* triplets) {
  for (int i = 0; i < 6; ++i) {
    triplets->emplace_back(row, column + i, entries[i]);
    triplets->emplace_back(column + i, row, entries[i]);
  }
}

Eigen::SparseMatrix<double> make_matrix(const std::vector<RigidBody>& bodies,
                                        const std::vector<BodyState>& state,
                                        const std::vector<ConstraintRow>& rows) {
  Triplets triplets;
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    const Index first = 6 * static_cast<Index>(k);
    add_block(first, first, bodies[k].mass * Matrix3d::Identity(), &triplets);
    add_block(first + 3, first + 3, rotate_inertia(bodies[k], state[k]), &triplets);
  }
  const Index motions = 6 * static_cast<Index>(bodies.size());
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const Index row = motions + static_cast<Index>(r);
    add_symmetric(row, 6 * rows[r].a, rows[r].ja, &triplets);
    add_symmetric(row, 6 * rows[r].b, rows[r].jb, &triplets);
  }
  const Index size = motions + static_cast<Index>(rows.size());
  Eigen::SparseMatrix<double> matrix(size, size);
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  return matrix;
}

VectorXd make_right_side(const std::vector<RigidBody>& bodies, const std::vector<BodyState>& state,
                         const std::vector<ConstraintRow>& rows,
                         const std::vector<Wrench>& wrenches) {
  const Index motions = 6 * static_cast<Index>(bodies.size());
  VectorXd right(motions + static_cast<Index>(rows.size()));
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    const Vector3d& w = state[k].angular_velocity;
    const Vector3d gyroscopic = w.cross(rotate_inertia(bodies[k], state[k]) * w);
    right.segment<6>(6 * static_cast<Index>(k)) =
        stack(wrenches[k].force, wrenches[k].moment - gyroscopic);
  }
  for (std::size_t r = 0; r < rows.size(); ++r) {
    right[motions + static_cast<Index>(r)] = rows[r].gamma;
  }
  return right;
}

}  // namespace

Joint make_coincident(int a, int b, const Vector3d& point_a, const Vector3d& point_b) {
  Joint joint;
  joint.kind = JointKind::kCoincident;
  joint.a = a;
  joint.b = b;
  joint.point_a = point_a;
  joint.point_b = point_b;
  return joint;
}

Joint make_perpendicular(int a, int b, const Vector3d& axis_a, const Vector3d& axis_b) {
  Joint joint;
  joint.kind = JointKind::kPerpendicular;
  joint.a = a;
  joint.b = b;
  joint.axis_a = axis_a;
  joint.axis_b = axis_b;
  return joint;
}

Joint make_projection(int a, int b, const Vector3d& axis_a, const Vector3d& point_a,
                      const Vector3d& point_b, double offset) {
  Joint joint;
  joint.kind = JointKind::kProjection;
  joint.a = a;
  joint.b = b;
  joint.axis_a = axis_a;
  joint.point_a = point_a;
  joint.point_b = point_b;
  joint.offset = offset;
  return joint;
}

void add_rows(const Joint& joint, const std::vector<BodyState>& state,
              std::vector<ConstraintRow>* rows) {
  const BodyState& a = at(state, joint.a);
  const BodyState& b = at(state, joint.b);
  switch (joint.kind) {
    case JointKind::kCoincident:
      return add_coincident(joint, a, b, rows);
    case JointKind::kPerpendicular:
      return add_perpendicular(joint, a, b, rows);
    case JointKind::kProjection:
      return add_projection(joint, a, b, rows);
  }
}

void add_force_at(const BodyState& state, const Vector3d& s, const Vector3d& force,
                  Wrench* wrench) {
  wrench->force += force;
  wrench->moment += state.rotate(s).cross(force);
}

Matrix3d rotate_inertia(const RigidBody& body, const BodyState& state) {
  const Matrix3d r = state.orientation.toRotationMatrix();
  return r * body.inertia * r.transpose();
}

std::vector<Twist6> solve_accelerations(const std::vector<RigidBody>& bodies,
                                        const std::vector<BodyState>& state,
                                        const std::vector<ConstraintRow>& rows,
                                        const std::vector<Wrench>& wrenches) {
  const Eigen::SparseMatrix<double> matrix = make_matrix(bodies, state, rows);
  const VectorXd right = make_right_side(bodies, state, rows, wrenches);
  Eigen::SparseLU<Eigen::SparseMatrix<double>> solver(matrix);
  if (solver.info() != Eigen::Success) {
    throw std::runtime_error("full-coordinate model: dependent constraints, " +
                             solver.lastErrorMessage());
  }
  VectorXd solution = solver.solve(right);
  solution += solver.solve(right - matrix * solution);
  std::vector<Twist6> accelerations(bodies.size());
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    accelerations[k] = solution.segment<6>(6 * static_cast<Index>(k));
  }
  return accelerations;
}

double calc_kinetic_energy(const std::vector<RigidBody>& bodies,
                           const std::vector<BodyState>& state) {
  double energy = 0.0;
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    const Vector3d& w = state[k].angular_velocity;
    energy += 0.5 * bodies[k].mass * state[k].velocity.squaredNorm() +
              0.5 * w.dot(rotate_inertia(bodies[k], state[k]) * w);
  }
  return energy;
}

}  // namespace strut::reference
