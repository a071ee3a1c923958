// Loop closure of a corner by Newton iteration, in chassis axes with the chassis at rest
// (docs/theory.md, section 2).
#pragma once

#include "model/multibody/corner.h"

namespace strut {

inline constexpr int kPredictorTerms = 13;
inline constexpr int kNewtonIterations = 1;  // suffices: the predictor is accurate to 1e-12 m

/// Initial guess of the dependent coordinates: polynomials in q / half_travel, lowest power first.
/// It depends on q only, so a closure has no memory and the result of a case no history. C: double
/// for one corner, the same in all lanes, or a lane type for one corner per lane.
template <class C>
struct ClosurePredictor {
  double half_travel = 0.1;  // m
  std::array<std::array<C, kMaxDependent>, kPredictorTerms> coefficient{};
};

/// A part's displacement from nominal trim: r = rotation r_nominal + shift.
template <class T>
struct Displacement {
  Mat3<T> rotation;
  Vec3<T> shift;
  Vec3<T> apply(const Vec3<T>& r_nominal) const { return rotation * r_nominal + shift; }
};

/// Positions of a corner at given joint coordinates.
template <class T>
struct CornerPose {
  std::array<Displacement<T>, kMaxJoints> part;
  std::array<Twist<T>, kMaxJoints> joint;  // b_k: twist of the part per unit joint rate
  std::array<Vec3<T>, kMaxRods> rod_end;   // m, upright ends
  Vec3<T> ball_on_upright, ball_on_arm;    // m
};

/// Joint axes, points and part displacements for joint coordinates z.
template <CornerTree kTree, class T>
void update_pose(const CornerGeometry<T>& geometry, const std::array<T, kMaxJoints>& z,
                 CornerPose<T>& pose) {
  const Vec3<T> zero{T(0.0), T(0.0), T(0.0)};
#pragma GCC unroll 8
  for (int k = 0; k < kTree.joint_count; ++k) {
    const int parent = kTree.parent[k];
    const bool on_chassis = parent == kChassisPart;
    const Displacement<T> carrier = on_chassis ? Displacement<T>{Mat3<T>::identity(), zero}
                                               : pose.part[on_chassis ? 0 : parent];
    const Vec3<T> axis = on_chassis ? geometry.axis[k] : carrier.rotation * geometry.axis[k];
    if (kTree.kind[k] == JointKind::kPrismatic) {
      pose.joint[k] = {axis, zero};
      pose.part[k] = {carrier.rotation, carrier.shift + z[k] * axis};
      continue;
    }
    const Vec3<T> point = on_chassis ? geometry.point[k] : carrier.apply(geometry.point[k]);
    const Mat3<T> turn = rotation_about(axis, z[k]);
    pose.joint[k] = {cross(point, axis), axis};
    pose.part[k] = {on_chassis ? turn : turn * carrier.rotation,
                    turn * (carrier.shift - point) + point};
  }
  const Displacement<T>& upright = pose.part[kTree.upright];
#pragma GCC unroll 8
  for (int rod = 0; rod < kTree.rod_count; ++rod) {
    pose.rod_end[rod] = upright.apply(geometry.rod_upright[rod]);
  }
  if (kTree.has_cut_ball) {
    pose.ball_on_upright = upright.apply(geometry.ball);
    pose.ball_on_arm = pose.part[kTree.ball_part].apply(geometry.ball);
  }
}

template <class T>
using LoopMatrix = std::array<std::array<T, kMaxDependent>, kMaxDependent>;
template <class T>
using LoopVector = std::array<T, kMaxDependent>;

template <class T>
void set_ball_rows(const Vec3<T>& v, LoopVector<T>& rows) {
  rows[0] = v.x;
  rows[1] = v.y;
  rows[2] = v.z;
}

/// Phi: cut ball joint, r_upright - r_arm (3 rows, m); rods, (|d|^2 - L^2) / (2 L) (m).
template <CornerTree kTree, class T>
LoopVector<T> calc_loop_error(const CornerGeometry<T>& geometry, const CornerPose<T>& pose) {
  LoopVector<T> error{};
  constexpr int kFirstRod = kTree.has_cut_ball ? 3 : 0;
  if (kTree.has_cut_ball) set_ball_rows(pose.ball_on_upright - pose.ball_on_arm, error);
#pragma GCC unroll 8
  for (int rod = 0; rod < kTree.rod_count; ++rod) {
    const Vec3<T> d = pose.rod_end[rod] - geometry.rod_chassis[rod];
    const T& length = geometry.rod_length[rod];
    error[kFirstRod + rod] = (dot(d, d) - length * length) / (T(2.0) * length);
  }
  return error;
}

/// dPhi/dz_joint: rows as in calc_loop_error.
template <CornerTree kTree, class T>
LoopVector<T> calc_loop_column(const CornerGeometry<T>& geometry, const CornerPose<T>& pose,
                               int joint) {
  LoopVector<T> column{};
  constexpr int kFirstRod = kTree.has_cut_ball ? 3 : 0;
  const Twist<T>& b = pose.joint[joint];
  const bool moves_upright = kTree.moves(joint, kTree.upright);
  if (kTree.has_cut_ball) {
    set_ball_rows(moves_upright ? b.at(pose.ball_on_upright) : -b.at(pose.ball_on_arm), column);
  }
  if (!moves_upright) return column;
#pragma GCC unroll 8
  for (int rod = 0; rod < kTree.rod_count; ++rod) {
    const Vec3<T> d = pose.rod_end[rod] - geometry.rod_chassis[rod];
    column[kFirstRod + rod] = dot(d, b.at(pose.rod_end[rod])) / geometry.rod_length[rod];
  }
  return column;
}

/// Phi_d = L U in the fixed elimination order of the topology (no pivoting in lanes).
template <class T>
struct LoopFactor {
  LoopMatrix<T> lu;  // permuted; unit lower triangle below the diagonal, inverse pivots on it
};

template <CornerTree kTree, class T>
void factor_loops(const CornerTopology& topology, const CornerGeometry<T>& geometry,
                  const CornerPose<T>& pose, LoopFactor<T>& factor) {
  constexpr int n = kTree.dependent_count();
  LoopMatrix<T> columns;
#pragma GCC unroll 8
  for (int d = 0; d < n; ++d) {
    columns[d] = calc_loop_column<kTree>(geometry, pose, kTree.dependent(d));
  }
  LoopMatrix<T> a;
#pragma GCC unroll 8
  for (int j = 0; j < n; ++j) {
    const LoopVector<T>& column = columns[topology.pivot_column[j]];
    for (int i = 0; i < n; ++i) a[i][j] = column[topology.pivot_row[i]];
  }
#pragma GCC unroll 8
  for (int k = 0; k < n; ++k) {
    a[k][k] = T(1.0) / a[k][k];
#pragma GCC unroll 8
    for (int i = k + 1; i < n; ++i) {
      a[i][k] *= a[k][k];
#pragma GCC unroll 8
      for (int j = k + 1; j < n; ++j) a[i][j] -= a[i][k] * a[k][j];
    }
  }
  factor.lu = a;
}

/// Phi_d^-1 b, in the order of the dependent coordinates.
template <CornerTree kTree, class T>
LoopVector<T> solve_loops(const CornerTopology& topology, const LoopFactor<T>& factor,
                          const LoopVector<T>& b) {
  constexpr int n = kTree.dependent_count();
  LoopVector<T> y, x{};
#pragma GCC unroll 8
  for (int i = 0; i < n; ++i) {
    y[i] = b[topology.pivot_row[i]];
#pragma GCC unroll 8
    for (int j = 0; j < i; ++j) y[i] -= factor.lu[i][j] * y[j];
  }
#pragma GCC unroll 8
  for (int i = n - 1; i >= 0; --i) {
#pragma GCC unroll 8
    for (int j = i + 1; j < n; ++j) y[i] -= factor.lu[i][j] * y[j];
    y[i] *= factor.lu[i][i];
  }
  for (int i = 0; i < n; ++i) x[topology.pivot_column[i]] = y[i];
  return x;
}

/// Joint coordinates at q from the predictor.
template <CornerTree kTree, class T, class C>
std::array<T, kMaxJoints> predict_joints(const ClosurePredictor<C>& predictor, const T& q) {
  std::array<T, kMaxJoints> z{};
  const T x = q * T(1.0 / predictor.half_travel);
  constexpr int n = kTree.dependent_count();
  LoopVector<T> value;
  for (int d = 0; d < n; ++d) value[d] = T(predictor.coefficient[kPredictorTerms - 1][d]);
  for (int i = kPredictorTerms - 2; i >= 0; --i) {
#pragma GCC unroll 8
    for (int d = 0; d < n; ++d) value[d] = value[d] * x + T(predictor.coefficient[i][d]);
  }
  for (int d = 0; d < n; ++d) z[kTree.dependent(d)] = value[d];
  z[kTree.independent] = q;
  return z;
}

/// Closes the loops at coordinate z[independent] from the initial guess z by `iterations` Newton
/// steps. Sets pose and factor at the solution; returns the maximum residual loop error [m].
template <CornerTree kTree, class T>
T close_loops(const CornerTopology& topology, const CornerGeometry<T>& geometry, int iterations,
              std::array<T, kMaxJoints>& z, CornerPose<T>& pose, LoopFactor<T>& factor) {
  update_pose<kTree>(geometry, z, pose);
  LoopVector<T> error = calc_loop_error<kTree>(geometry, pose);
  for (int iteration = 0; iteration < iterations; ++iteration) {
    factor_loops<kTree>(topology, geometry, pose, factor);
    const LoopVector<T> step = solve_loops<kTree>(topology, factor, error);
    for (int d = 0; d < kTree.dependent_count(); ++d) z[kTree.dependent(d)] -= step[d];
    update_pose<kTree>(geometry, z, pose);
    error = calc_loop_error<kTree>(geometry, pose);
  }
  factor_loops<kTree>(topology, geometry, pose, factor);
  T worst = T(0.0);
  for (int row = 0; row < kTree.constraint_count(); ++row) worst = max(worst, abs(error[row]));
  return worst;
}

}  // namespace strut
