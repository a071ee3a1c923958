// One suspension corner as data: a small tree of one-degree-of-freedom joints on the chassis, loops
// closed by cut ball joints and removed rods, one independent coordinate q.
//
// All positions are given at nominal trim in chassis axes (origin: the whole car's centroid there).
// A moving part has no frame of its own: its displacement maps nominal to current points,
// r = R r_nominal + p, so all displacements are the identity at nominal trim.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "base/math/spatial.h"

namespace strut {

inline constexpr int kMaxJoints = 6;
inline constexpr int kMaxBodies = 3;
inline constexpr int kMaxRods = 5;
inline constexpr int kMaxDependent = 5;
/// Line elements of a corner: a spring and a damper each act along the line of their two mounts.
inline constexpr int kLines = 2;
enum Line : int { kSpringLine = 0, kDamperLine = 1 };

inline constexpr int kChassisPart = -1;

enum class JointKind : std::int8_t { kRevolute, kPrismatic };

/// Attachment of one end of a line: to a part (joint index or kChassisPart), or to a rod.
struct Attachment {
  int part = kChassisPart;
  int rod = -1;  // >= 0: on this rod, `rod_fraction` of the way from chassis to upright, and
                 // `rod_offset` beside its line
  bool operator==(const Attachment&) const = default;
};

/// Joints and loops of a kind of suspension. Values of this type are template arguments, so that
/// loops over joints are unrolled although the suspension is data.
struct CornerTree {
  int joint_count = 0;
  std::array<JointKind, kMaxJoints> kind{};
  std::array<int, kMaxJoints> parent{};  // joint that carries this one, or kChassisPart
  int independent = 0;                   // joint whose coordinate is q
  int upright = 0;                       // joint whose part is the upright
  bool has_cut_ball = false;
  int ball_part = 0;  // the other side of the cut ball is the upright
  int rod_count = 0;

  constexpr int dependent_count() const { return joint_count - 1; }
  /// Joint of dependent coordinate d = 0..dependent_count-1.
  constexpr int dependent(int d) const { return d < independent ? d : d + 1; }
  constexpr int constraint_count() const { return (has_cut_ball ? 3 : 0) + rod_count; }
  /// Whether motion of `joint` moves `part`.
  constexpr bool moves(int joint, int part) const {
    for (; part != kChassisPart; part = parent[static_cast<std::size_t>(part)]) {
      if (part == joint) return true;
    }
    return false;
  }
};

/// Lower arm (0); strut: ball joint at the top as three revolutes (1-3), slide (4) that carries the
/// upright, q its shortening. Cut: ball joint of the arm. Removed: tie rod.
inline constexpr CornerTree kMacPhersonTree{
    .joint_count = 5,
    .kind = {JointKind::kRevolute, JointKind::kRevolute, JointKind::kRevolute, JointKind::kRevolute,
             JointKind::kPrismatic},
    .parent = {kChassisPart, kChassisPart, 1, 2, 3},
    .independent = 4,
    .upright = 4,
    .has_cut_ball = true,
    .ball_part = 0,
    .rod_count = 1};

/// Upright floating on the chassis: three prismatic (0-2, q the vertical one), three revolute
/// (3-5). Removed: five rods.
inline constexpr CornerTree kMultilinkTree{
    .joint_count = 6,
    .kind = {JointKind::kPrismatic, JointKind::kPrismatic, JointKind::kPrismatic,
             JointKind::kRevolute, JointKind::kRevolute, JointKind::kRevolute},
    .parent = {kChassisPart, 0, 1, 2, 3, 4},
    .independent = 2,
    .upright = 5,
    .has_cut_ball = false,
    .ball_part = 0,
    .rod_count = 5};

enum class SuspensionKind : std::int8_t { kMacPherson, kMultilink };

constexpr const CornerTree& get_tree(SuspensionKind kind) {
  return kind == SuspensionKind::kMacPherson ? kMacPhersonTree : kMultilinkTree;
}

/// Bodies and lines of the tree of one corner, and the elimination order of its loop equations;
/// common to a batch.
struct CornerTopology {
  SuspensionKind kind = SuspensionKind::kMacPherson;
  int body_count = 0;
  std::array<int, kMaxBodies> body_part{};  // part each body is fixed to
  std::array<std::array<Attachment, 2>, kLines> line{};
  std::array<int, kMaxDependent> pivot_row{};     // elimination order of the loop equations, found
  std::array<int, kMaxDependent> pivot_column{};  // at nominal trim; the same in every lane
  bool operator==(const CornerTopology&) const = default;
};

/// Hardpoints at nominal trim [m], chassis axes.
template <class T>
struct CornerGeometry {
  std::array<Vec3<T>, kMaxJoints> axis, point;  // joint axes (unit) and points
  Vec3<T> ball;                                 // cut ball joint
  std::array<Vec3<T>, kMaxRods> rod_chassis, rod_upright;
  std::array<T, kMaxRods> rod_length;
  Vec3<T> wheel_center, spin_axis;  // spin axis is a unit vector
  std::array<std::array<Vec3<T>, 2>, kLines> line_point;
  std::array<std::array<T, 2>, kLines> rod_fraction;
  std::array<std::array<Vec3<T>, 2>, kLines> rod_offset;  // perpendicular to the rod
};

/// Rigid body at nominal trim: mass [kg], center of mass [m], central inertia [kg m^2].
template <class T>
struct RigidBody {
  T mass;
  Vec3<T> center;
  Sym3<T> inertia;
};

/// Removed rod: kinetic energy (m_aa vA.vA + 2 m_ab vA.vB + m_bb vB.vB) / 2, exact for a slender
/// rod between its chassis end A and its upright end B [kg].
template <class T>
struct RodInertia {
  T aa, ab, bb;
};

template <class T>
struct CornerInertia {
  std::array<RigidBody<T>, kMaxBodies> body;  // the upright's includes the wheel, not its spin
  std::array<RodInertia<T>, kMaxRods> rod;
  T spin_inertia;  // kg m^2, wheel about its axis
};

/// Motion functions of a corner at coordinate q for the equations of motion: the composite of its
/// bodies and rods about the chassis origin, the position of its wheel and the lengths of its
/// lines. A suffix _q (_qq) is the first (second) derivative with respect to q. All inertia
/// excludes the wheel's spin about its axis (see dynamics.h).
template <class T>
struct CornerMotion {
  Vec3<T> moment, moment_q, moment_qq;  // first moment sum m r; moment_q: momentum per unit q_dot
  Sym3<T> inertia, inertia_q;           // about the chassis origin
  Vec3<T> coupling, coupling_q;         // angular momentum per unit q_dot
  T mass, mass_q;                       // generalized mass: 2 kinetic energy / q_dot^2
  Vec3<T> center, center_q, center_qq;  // wheel center
  Vec3<T> axis, axis_q;                 // spin axis
  Vec3<T> upright_rate;                 // angular velocity of the upright per unit q_dot
  std::array<T, kLines> length, length_q;
};

}  // namespace strut
