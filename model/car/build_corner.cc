#include "model/car/build_corner.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error/check.h"
#include "base/math/chebyshev.h"
#include "model/error/model_error.h"

namespace strut {
namespace {

constexpr double kMinPivot = 1e-4;           // m; below, the loop equations count as singular
constexpr double kMaxLoopError = 1e-12;      // m
constexpr double kMaxJointCoordinate = 1.2;  // rad or m; beyond, Newton has left the assembly mode

Vec3<double> mirrored(const Vec3<double>& r) { return {r.x, -r.y, r.z}; }

Sym3<double> mirrored(const Sym3<double>& j) { return {j.xx, j.yy, j.zz, -j.xy, j.xz, -j.yz}; }

/// Places a left-corner point of an axle in chassis axes, mirrored for the right corner.
struct Placement {
  Vec3<double> origin;
  bool right = false;

  Vec3<double> point(const Vec3<double>& r) const { return origin + direction(r); }
  Vec3<double> direction(const Vec3<double>& d) const { return right ? mirrored(d) : d; }
  RigidBody<double> body(const BodySpec& b) const {
    return {b.mass, point(b.center_of_mass), right ? mirrored(b.inertia) : b.inertia};
  }
};

/// The three revolutes of a ball joint at `point`, from joint `first` on.
void set_ball(int first, const Vec3<double>& point, CornerGeometry<double>& geometry) {
  const Vec3<double> axes[3] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
  for (int i = 0; i < 3; ++i) {
    geometry.point[first + i] = point;
    geometry.axis[first + i] = axes[i];
  }
}

void add_body(CornerTopology& topology, CornerInertia<double>& inertia, int part,
              const RigidBody<double>& body) {
  if (body.mass == 0.0) return;
  STRUT_CHECK(topology.body_count < kMaxBodies, "a corner has more bodies than its capacity");
  topology.body_part[topology.body_count] = part;
  inertia.body[topology.body_count++] = body;
}

/// Sets the joints and bodies of kMacPhersonTree.
void build_macpherson(const SuspensionSpec& spec, const Placement& place, BuiltCorner& parts) {
  constexpr int kArm = 0, kStrutBall = 1, kStrutRod = 3, kSlide = 4;
  CornerGeometry<double>& geometry = parts.geometry;
  const Vec3<double> top = place.point(spec.strut_top);
  geometry.point[kArm] = place.point(spec.arm_front);
  geometry.axis[kArm] = normalized(place.point(spec.arm_rear) - geometry.point[kArm]);
  set_ball(kStrutBall, top, geometry);
  geometry.point[kSlide] = top;
  geometry.axis[kSlide] = normalized(top - place.point(spec.strut_bottom));
  geometry.ball = place.point(spec.ball_joint);
  add_body(parts.topology, parts.inertia, kArm, place.body(spec.lower_arm));
  add_body(parts.topology, parts.inertia, kStrutRod, place.body(spec.strut_rod));
}

/// Sets the joints of kMultilinkTree.
void build_multilink(const Vec3<double>& center, BuiltCorner& parts) {
  set_ball(0, center, parts.geometry);  // the prismatic joints have the same three axes
  set_ball(3, center, parts.geometry);
}

/// Inertia of a rigid rod of mass m, with its center at fraction a from the chassis end and the
/// central transverse inertia J.
RodInertia<double> calc_rod_inertia(const RodSpec& rod) {
  const Vec3<double> d = rod.upright - rod.chassis;
  const double a = rod.center_fraction, m = rod.mass;
  const double per_length2 =
      rod.transverse_inertia < 0.0 ? m / 12.0 : rod.transverse_inertia / dot(d, d);
  return {m * square(1.0 - a) + per_length2, m * a * (1.0 - a) - per_length2,
          m * square(a) + per_length2};
}

void add_rods(const SuspensionSpec& spec, const Placement& place, double rack, BuiltCorner& parts) {
  CornerGeometry<double>& geometry = parts.geometry;
  const int expected = get_tree(spec.kind).rod_count;
  if (static_cast<int>(spec.rods.size()) != expected) {
    throw ModelError(
        fmt::format("suspension: {} rods; allowed: {} ({})", spec.rods.size(), expected,
                    expected == 1 ? "the tie rod of a MacPherson strut" : "a multilink"));
  }
  for (int i = 0; i < expected; ++i) {
    const RodSpec& rod = spec.rods[static_cast<std::size_t>(i)];
    geometry.rod_chassis[i] = place.point(rod.chassis);
    geometry.rod_upright[i] = place.point(rod.upright);
    geometry.rod_length[i] = norm(geometry.rod_upright[i] - geometry.rod_chassis[i]);
    parts.inertia.rod[i] = calc_rod_inertia(rod);
  }
  if (spec.kind == SuspensionKind::kMacPherson) geometry.rod_chassis[spec.tie_rod].y += rack;
}

Attachment find_attachment(const MountSpec& mount, const BuiltCorner& parts) {
  switch (mount.body) {
    case MountBody::kChassis:
      return {kChassisPart, -1};
    case MountBody::kUpright:
      return {get_tree(parts.topology.kind).upright, -1};
    case MountBody::kLowerArm:
      if (parts.topology.kind != SuspensionKind::kMacPherson) {
        throw ModelError("mount: lower_arm is a part of MacPherson suspensions only");
      }
      return {kMacPhersonTree.ball_part, -1};
    case MountBody::kRod:
      return {kChassisPart, mount.rod};
  }
  throw ModelError("mount: unknown body");
}

void add_lines(const SuspensionSpec& spec, const Placement& place, BuiltCorner& parts) {
  const MountSpec* mounts[kLines][2] = {{&spec.spring_upper, &spec.spring_lower},
                                        {&spec.damper_upper, &spec.damper_lower}};
  CornerGeometry<double>& geometry = parts.geometry;
  for (int line = 0; line < kLines; ++line) {
    for (int end = 0; end < 2; ++end) {
      const MountSpec& mount = *mounts[line][end];
      parts.topology.line[line][end] = find_attachment(mount, parts);
      geometry.line_point[line][end] = place.point(mount.position);
      geometry.rod_fraction[line][end] = 0.0;
      geometry.rod_offset[line][end] = {0.0, 0.0, 0.0};
      if (mount.body == MountBody::kRod) {
        const Vec3<double> a = geometry.rod_chassis[mount.rod];
        const Vec3<double> d = geometry.rod_upright[mount.rod] - a;
        const Vec3<double> arm = place.point(mount.position) - a;
        geometry.rod_fraction[line][end] = dot(arm, d) / dot(d, d);
        geometry.rod_offset[line][end] = arm - geometry.rod_fraction[line][end] * d;
      }
    }
  }
}

/// Combines upright, hub and wheel into one body, without the wheel's inertia about its axis.
RigidBody<double> combine_upright_and_wheel(const SuspensionSpec& spec, const Placement& place,
                                            const Vec3<double>& center, const Vec3<double>& axis) {
  const RigidBody<double> upright = place.body(spec.upright);
  const double mass = upright.mass + spec.wheel_mass;
  const Vec3<double> com =
      (1.0 / mass) * (upright.mass * upright.center + spec.wheel_mass * center);
  const auto offset = [&](double m, const Vec3<double>& r) {
    return (0.5 * m) * inertia_form(r - com, r - com);
  };
  const Sym3<double> disc =
      spec.wheel_transverse_inertia * (isotropic(1.0) - 0.5 * symmetric_outer(axis, axis));
  return {mass, com,
          upright.inertia + disc + offset(upright.mass, upright.center) +
              offset(spec.wheel_mass, center)};
}

/// Elimination order of Phi_d by complete pivoting at nominal trim.
template <CornerTree kTree>
void choose_pivots(const CornerGeometry<double>& geometry, const char* where,
                   CornerTopology& topology) {
  constexpr int n = kTree.dependent_count();
  static_assert(n == kTree.constraint_count());
  CornerPose<double> pose;
  update_pose<kTree>(geometry, {}, pose);
  LoopMatrix<double> a{};
  for (int j = 0; j < n; ++j) {
    const LoopVector<double> column = calc_loop_column<kTree>(geometry, pose, kTree.dependent(j));
    for (int i = 0; i < n; ++i) a[i][j] = column[i];
    topology.pivot_row[j] = topology.pivot_column[j] = j;
  }
  for (int k = 0; k < n; ++k) {
    int row = k, column = k;
    for (int i = k; i < n; ++i) {
      for (int j = k; j < n; ++j) {
        if (std::abs(a[i][j]) > std::abs(a[row][column])) row = i, column = j;
      }
    }
    if (std::abs(a[row][column]) < kMinPivot) {
      throw ModelError(
          fmt::format("{}: hardpoints: the loop equations are singular at nominal trim", where));
    }
    std::swap(a[k], a[row]);
    std::swap(topology.pivot_row[k], topology.pivot_row[row]);
    for (int i = 0; i < n; ++i) std::swap(a[i][k], a[i][column]);
    std::swap(topology.pivot_column[k], topology.pivot_column[column]);
    for (int i = k + 1; i < n; ++i) {
      const double factor = a[i][k] / a[k][k];
      for (int j = k; j < n; ++j) a[i][j] -= factor * a[k][j];
    }
  }
}

using JointSamples = std::vector<std::array<double, kMaxJoints>>;

/// Joint coordinates at every node, each by Newton from the neighbor nearer to nominal trim.
template <CornerTree kTree>
JointSamples close_over_travel(const CornerTopology& topology,
                               const CornerGeometry<double>& geometry, const char* where) {
  constexpr int kIterations = 12;
  JointSamples joints(kChebyshevNodes);
  for (int side = 0; side < 2; ++side) {
    std::array<double, kMaxJoints> z{};
    for (int k = kChebyshevNodes / 2; k < kChebyshevNodes; ++k) {
      const int node = side == 0 ? k : kChebyshevNodes - 1 - k;
      z[kTree.independent] = kHalfTravel * calc_chebyshev_node(node);
      CornerPose<double> pose;
      LoopFactor<double> factor;
      const double error = close_loops<kTree>(topology, geometry, kIterations, z, pose, factor);
      const bool is_far = std::any_of(z.begin(), z.end(), [](double coordinate) {
        return std::abs(coordinate) > kMaxJointCoordinate;
      });
      if (!(error < kMaxLoopError) || is_far) {
        throw ModelError(fmt::format(
            "{}: hardpoints cannot close the loop at {:g} mm of travel (loop error {:g} "
            "m); allowed: closed over +/-{:g} mm",
            where, 1e3 * z[kTree.independent], error, 1e3 * kHalfTravel));
      }
      joints[static_cast<std::size_t>(node)] = z;
    }
  }
  return joints;
}

template <CornerTree kTree>
ClosurePredictor<double> fit_predictor(const JointSamples& joints) {
  ClosurePredictor<double> predictor;
  predictor.half_travel = kHalfTravel;
  for (int d = 0; d < kTree.dependent_count(); ++d) {
    std::vector<double> values;
    for (const auto& z : joints) values.push_back(z[kTree.dependent(d)]);
    const auto power = convert_to_powers(calc_chebyshev_series(values), kPredictorTerms - 1);
    for (std::size_t i = 0; i < power.size(); ++i) {
      predictor.coefficient[i][d] = static_cast<double>(power[i]);
    }
  }
  return predictor;
}

/// Sets pivots and predictor of a corner.
template <CornerTree kTree>
void prepare_closure(const char* where, BuiltCorner& corner) {
  choose_pivots<kTree>(corner.geometry, where, corner.topology);
  corner.predictor =
      fit_predictor<kTree>(close_over_travel<kTree>(corner.topology, corner.geometry, where));
}

}  // namespace

const char* get_axle_key(int axle) {
  return axle == kFront ? "front_suspension" : "rear_suspension";
}

Vec3<double> calc_spin_axis(const SuspensionSpec& spec, bool right) {
  const double toe = spec.static_toe, camber = spec.static_camber;
  const Vec3<double> left{std::sin(toe) * std::cos(camber), std::cos(toe) * std::cos(camber),
                          -std::sin(camber)};
  return right ? Vec3<double>{-left.x, left.y, -left.z} : left;
}

BuiltCorner build_corner(const VehicleSpec& spec, int corner, const Vec3<double>& reference,
                         double rack) {
  const SuspensionSpec& suspension = spec.suspension[axle_of(corner)];
  const Placement place{reference, is_right(corner)};
  BuiltCorner parts;
  parts.topology.kind = suspension.kind;
  const Vec3<double> center = place.point({0.0, suspension.wheel_center_y, 0.0});
  if (suspension.kind == SuspensionKind::kMacPherson) {
    build_macpherson(suspension, place, parts);
  } else {
    build_multilink(center, parts);
  }
  add_rods(suspension, place, axle_of(corner) == kFront ? rack : 0.0, parts);
  parts.geometry.wheel_center = center;
  parts.geometry.spin_axis = calc_spin_axis(suspension, place.right);
  add_lines(suspension, place, parts);
  parts.inertia.spin_inertia = suspension.wheel_spin_inertia;
  add_body(parts.topology, parts.inertia, get_tree(suspension.kind).upright,
           combine_upright_and_wheel(suspension, place, center, parts.geometry.spin_axis));
  const auto prepare = suspension.kind == SuspensionKind::kMacPherson
                           ? &prepare_closure<kMacPhersonTree>
                           : &prepare_closure<kMultilinkTree>;
  prepare(get_axle_key(axle_of(corner)), parts);
  return parts;
}

}  // namespace strut
