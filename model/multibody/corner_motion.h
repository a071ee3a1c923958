// Motion functions of a closed corner: the motion of its parts with q, and their composite inertia.
//
// All in chassis axes with the chassis at rest and q_dot = 1, so that a twist is a derivative with
// respect to q (docs/theory.md, sections 2 and 3).
#pragma once

#include "model/multibody/closure.h"

namespace strut {

/// First and second derivative of every part's motion with respect to q.
template <class T>
struct PartMotion {
  std::array<Twist<T>, kMaxJoints> rate;   // beta_k
  std::array<Twist<T>, kMaxJoints> accel;  // gamma_k
};

/// Point fixed to a moving part: position and its derivatives with respect to q [m, 1, 1/m].
template <class T>
struct PointMotion {
  Vec3<T> r, r_q, r_qq;
};

/// Motion of the part's point whose current position is r.
template <class T>
PointMotion<T> calc_point_at(const Twist<T>& rate, const Twist<T>& accel, const Vec3<T>& r) {
  const Vec3<T> r_q = rate.at(r);
  return {r, r_q, accel.at(r) + cross(rate.w, r_q)};
}

template <class T>
PointMotion<T> calc_point(const Displacement<T>& part, const Twist<T>& rate, const Twist<T>& accel,
                          const Vec3<T>& nominal) {
  return calc_point_at(rate, accel, part.apply(nominal));
}

/// gamma_Phi: second derivative of the loop equations at sigma = 0.
template <CornerTree kTree, class T>
LoopVector<T> calc_loop_curvature(const CornerGeometry<T>& geometry, const CornerPose<T>& pose,
                                  const PartMotion<T>& motion) {
  LoopVector<T> gamma{};
  constexpr int kFirstRod = kTree.has_cut_ball ? 3 : 0;
  const Twist<T>& rate = motion.rate[kTree.upright];
  const Twist<T>& accel = motion.accel[kTree.upright];
  if (kTree.has_cut_ball) {
    const PointMotion<T> a = calc_point_at(rate, accel, pose.ball_on_upright);
    const PointMotion<T> b = calc_point_at(motion.rate[kTree.ball_part],
                                           motion.accel[kTree.ball_part], pose.ball_on_arm);
    set_ball_rows(a.r_qq - b.r_qq, gamma);
  }
#pragma GCC unroll 8
  for (int rod = 0; rod < kTree.rod_count; ++rod) {
    const PointMotion<T> end = calc_point_at(rate, accel, pose.rod_end[rod]);
    const Vec3<T> d = end.r - geometry.rod_chassis[rod];
    gamma[kFirstRod + rod] = (dot(end.r_q, end.r_q) + dot(d, end.r_qq)) / geometry.rod_length[rod];
  }
  return gamma;
}

/// rho = -Phi_d^-1 Phi_i and sigma = -Phi_d^-1 gamma_Phi, summed along each path: beta and gamma.
template <CornerTree kTree, class T>
void update_part_motion(const CornerTopology& topology, const CornerGeometry<T>& geometry,
                        const CornerPose<T>& pose, const LoopFactor<T>& factor,
                        PartMotion<T>& motion) {
  constexpr int n = kTree.joint_count;
  const LoopVector<T> minus_rho = solve_loops<kTree>(
      topology, factor, calc_loop_column<kTree>(geometry, pose, kTree.independent));
  std::array<T, kMaxJoints> rho, sigma;
  rho[kTree.independent] = T(1.0);
  for (int d = 0; d < kTree.dependent_count(); ++d) rho[kTree.dependent(d)] = -minus_rho[d];
#pragma GCC unroll 8
  for (int k = 0; k < n; ++k) {
    const int parent = kTree.parent[k];
    motion.rate[k] = rho[k] * pose.joint[k];
    if (parent == kChassisPart) {
      motion.accel[k] = {{T(0.0), T(0.0), T(0.0)}, {T(0.0), T(0.0), T(0.0)}};
      continue;
    }
    motion.accel[k] = motion.accel[parent] + motion_cross(motion.rate[parent], motion.rate[k]);
    motion.rate[k] += motion.rate[parent];
  }

  const LoopVector<T> minus_sigma =
      solve_loops<kTree>(topology, factor, calc_loop_curvature<kTree>(geometry, pose, motion));
  sigma[kTree.independent] = T(0.0);
  for (int d = 0; d < kTree.dependent_count(); ++d) sigma[kTree.dependent(d)] = -minus_sigma[d];
  std::array<Twist<T>, kMaxJoints> correction;
#pragma GCC unroll 8
  for (int k = 0; k < n; ++k) {
    const int parent = kTree.parent[k];
    correction[k] = sigma[k] * pose.joint[k];
    if (parent != kChassisPart) correction[k] += correction[parent];
    motion.accel[k] += correction[k];
  }
}

template <class T>
void add_rigid_body(const RigidBody<T>& body, const Displacement<T>& part, const Twist<T>& rate,
                    const Twist<T>& accel, CornerMotion<T>& motion) {
  const PointMotion<T> c = calc_point(part, rate, accel, body.center);
  const Sym3<T> inertia = rotate(part.rotation, body.inertia);
  const Sym3<T> inertia_q = rotation_rate(rate.w, inertia);
  const Vec3<T> spin = inertia * rate.w;
  motion.moment += body.mass * c.r;
  motion.moment_q += body.mass * c.r_q;
  motion.moment_qq += body.mass * c.r_qq;
  motion.inertia += inertia + T(0.5) * body.mass * inertia_form(c.r, c.r);
  motion.inertia_q += inertia_q + body.mass * inertia_form(c.r, c.r_q);
  motion.coupling += body.mass * cross(c.r, c.r_q) + spin;
  motion.coupling_q += body.mass * cross(c.r, c.r_qq) + inertia_q * rate.w + inertia * accel.w;
  motion.mass += body.mass * dot(c.r_q, c.r_q) + dot(rate.w, spin);
  // w.(dJ/dq) w vanishes: the inertia turns with w itself.
  motion.mass_q += T(2.0) * (body.mass * dot(c.r_q, c.r_qq) + dot(spin, accel.w));
}

template <class T>
void add_rod(const RodInertia<T>& rod, const Vec3<T>& a, const PointMotion<T>& b,
             CornerMotion<T>& motion) {
  const Vec3<T> lever = rod.bb * b.r + rod.ab * a;
  motion.moment += (rod.aa + rod.ab) * a + (rod.ab + rod.bb) * b.r;
  motion.moment_q += (rod.ab + rod.bb) * b.r_q;
  motion.moment_qq += (rod.ab + rod.bb) * b.r_qq;
  motion.inertia += T(0.5) * rod.aa * inertia_form(a, a) +
                    T(0.5) * rod.bb * inertia_form(b.r, b.r) + rod.ab * inertia_form(a, b.r);
  motion.inertia_q += rod.bb * inertia_form(b.r, b.r_q) + rod.ab * inertia_form(a, b.r_q);
  motion.coupling += cross(lever, b.r_q);
  motion.coupling_q += cross(lever, b.r_qq);
  motion.mass += rod.bb * dot(b.r_q, b.r_q);
  motion.mass_q += T(2.0) * rod.bb * dot(b.r_q, b.r_qq);
}

/// A point with its derivative by q.
template <class T>
struct PointRate {
  Vec3<T> r, r_q;
};

/// The offset s of a mount beside its rod, whose unit vector has turned from e0 to e: turned by the
/// shortest rotation, since the rod's bushing keeps it from turning about its own line,
///
///   s' = s - (e . s) / (1 + e0 . e) (e0 + e)
template <class T>
PointRate<T> turn_offset(const Vec3<T>& s, const Vec3<T>& e0, const Vec3<T>& e,
                         const Vec3<T>& e_q) {
  const T scale = T(1.0) / (T(1.0) + dot(e0, e)), along = dot(e, s) * scale;
  const T along_q = (dot(e_q, s) - along * dot(e0, e_q)) * scale;
  return {s - along * (e0 + e), -(along_q * (e0 + e) + along * e_q)};
}

/// One end of a line.
template <class T>
PointRate<T> calc_attachment(const CornerTopology& topology, const CornerGeometry<T>& geometry,
                             const CornerPose<T>& pose, const PartMotion<T>& parts, int upright,
                             int line, int end) {
  const Attachment& attachment = topology.line[line][end];
  const Vec3<T>& nominal = geometry.line_point[line][end];
  if (attachment.rod >= 0) {
    const int rod = attachment.rod;
    const PointMotion<T> tip =
        calc_point_at(parts.rate[upright], parts.accel[upright], pose.rod_end[rod]);
    const Vec3<T>& a = geometry.rod_chassis[rod];
    const T shortness = T(1.0) / geometry.rod_length[rod];
    const PointRate<T> beside =
        turn_offset(geometry.rod_offset[line][end], shortness * (geometry.rod_upright[rod] - a),
                    shortness * (tip.r - a), shortness * tip.r_q);
    const T& fraction = geometry.rod_fraction[line][end];
    return {a + fraction * (tip.r - a) + beside.r, fraction * tip.r_q + beside.r_q};
  }
  if (attachment.part == kChassisPart) return {nominal, {T(0.0), T(0.0), T(0.0)}};
  const PointMotion<T> point = calc_point(pose.part[attachment.part], parts.rate[attachment.part],
                                          parts.accel[attachment.part], nominal);
  return {point.r, point.r_q};
}

/// Wheel center and axis, lengths of the lines.
template <CornerTree kTree, class T>
void update_wheel_and_lines(const CornerTopology& topology, const CornerGeometry<T>& geometry,
                            const CornerPose<T>& pose, const PartMotion<T>& parts,
                            CornerMotion<T>& motion) {
  constexpr int upright = kTree.upright;
  const Displacement<T>& knuckle = pose.part[upright];
  const PointMotion<T> center =
      calc_point(knuckle, parts.rate[upright], parts.accel[upright], geometry.wheel_center);
  motion.center = center.r;
  motion.center_q = center.r_q;
  motion.center_qq = center.r_qq;
  motion.axis = knuckle.rotation * geometry.spin_axis;
  motion.upright_rate = parts.rate[upright].w;
  motion.axis_q = cross(motion.upright_rate, motion.axis);
  for (int line = 0; line < kLines; ++line) {
    PointRate<T> end[2];
    for (int e = 0; e < 2; ++e) {
      end[e] = calc_attachment(topology, geometry, pose, parts, upright, line, e);
    }
    const Vec3<T> d = end[1].r - end[0].r;
    motion.length[line] = norm(d);
    motion.length_q[line] = dot(d, end[1].r_q - end[0].r_q) / motion.length[line];
  }
}

/// All motion functions of a corner whose loops are closed.
template <CornerTree kTree, class T>
void update_corner_motion(const CornerTopology& topology, const CornerGeometry<T>& geometry,
                          const CornerInertia<T>& inertia, const CornerPose<T>& pose,
                          const LoopFactor<T>& factor, CornerMotion<T>& motion) {
  PartMotion<T> parts;
  update_part_motion<kTree>(topology, geometry, pose, factor, parts);
  update_wheel_and_lines<kTree>(topology, geometry, pose, parts, motion);
  // Sums in registers, written once, because the compiler must assume that `motion` aliases its
  // inputs.
  CornerMotion<T> sum;
  const Vec3<T> zero{T(0.0), T(0.0), T(0.0)};
  sum.moment = sum.moment_q = sum.moment_qq = sum.coupling = sum.coupling_q = zero;
  sum.inertia = sum.inertia_q = isotropic<T>(T(0.0));
  sum.mass = sum.mass_q = T(0.0);
  for (int body = 0; body < topology.body_count; ++body) {
    const int part = topology.body_part[body];
    add_rigid_body(inertia.body[body], pose.part[part], parts.rate[part], parts.accel[part], sum);
  }
  constexpr int upright = kTree.upright;
#pragma GCC unroll 8
  for (int rod = 0; rod < kTree.rod_count; ++rod) {
    add_rod(inertia.rod[rod], geometry.rod_chassis[rod],
            calc_point_at(parts.rate[upright], parts.accel[upright], pose.rod_end[rod]), sum);
  }
  motion.moment = sum.moment;
  motion.moment_q = sum.moment_q;
  motion.moment_qq = sum.moment_qq;
  motion.inertia = sum.inertia;
  motion.inertia_q = sum.inertia_q;
  motion.coupling = sum.coupling;
  motion.coupling_q = sum.coupling_q;
  motion.mass = sum.mass;
  motion.mass_q = sum.mass_q;
}

/// Motion functions at q by Newton on the loops from the predictor; returns the residual loop error
/// [m].
template <CornerTree kTree, class T, class C>
T close_corner(const CornerTopology& topology, const ClosurePredictor<C>& predictor,
               const CornerGeometry<T>& geometry, const CornerInertia<T>& inertia, const T& q,
               CornerMotion<T>& motion) {
  CornerPose<T> pose;
  LoopFactor<T> factor;
  std::array<T, kMaxJoints> z = predict_joints<kTree>(predictor, q);
  const T error = close_loops<kTree>(topology, geometry, kNewtonIterations, z, pose, factor);
  update_corner_motion<kTree>(topology, geometry, inertia, pose, factor, motion);
  return error;
}

}  // namespace strut
