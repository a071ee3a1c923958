#include "tests/reference/car_layout.h"

#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>

namespace strut::reference {
namespace {

Vector3d to_eigen(const Vec3<double>& v) { return {v.x, v.y, v.z}; }

Matrix3d to_eigen(const Sym3<double>& s) {
  Matrix3d m;
  m << s.xx, s.xy, s.xz, s.xy, s.yy, s.yz, s.xz, s.yz, s.zz;
  return m;
}

/// m (d.d I - d d^T)
Matrix3d make_point_inertia(double mass, const Vector3d& d) {
  return mass * (d.squaredNorm() * Matrix3d::Identity() - d * d.transpose());
}

/// Two unit vectors that complete `axis` to a right-handed orthogonal frame.
std::array<Vector3d, 2> make_normals(const Vector3d& axis) {
  const Vector3d n = axis.unitOrthogonal();
  return {n, axis.cross(n)};
}

/// Adds the bodies and joints of one corner to the layout.
class CornerBuilder {
 public:
  CornerBuilder(const VehicleSpec& spec, int corner, double gravity, CarLayout* layout)
      : suspension_(spec.suspension[static_cast<std::size_t>(axle_of(corner))]),
        mirror_(1.0, is_right(corner) ? -1.0 : 1.0, 1.0),
        layout_(*layout),
        corner_(layout->corners[static_cast<std::size_t>(corner)]) {
    const bool front = axle_of(corner) == kFront;
    const WholeCarSpec& whole = spec.whole;
    const double base = whole.centroid_to_front + whole.centroid_to_rear;
    const double arm = front ? whole.centroid_to_rear : whole.centroid_to_front;
    corner_.static_load = 0.5 * whole.mass * gravity * arm / base;
    const double loaded = spec.tire.unloaded_radius - corner_.static_load / spec.tire.stiffness;
    reference_ = {front ? whole.centroid_to_front : -whole.centroid_to_rear, 0.0,
                  loaded * std::cos(suspension_.static_camber) - whole.centroid_height};
    corner_.drive_share = 0.5 * suspension_.drive_share;
    steered_ = front;
  }

  void build() {
    corner_.first_body = static_cast<int>(layout_.bodies.size());
    add_upright_and_wheel();
    if (suspension_.kind == SuspensionKind::kMacPherson) {
      add_macpherson();
    } else {
      add_multilink();
    }
    for (std::size_t i = 0; i < suspension_.rods.size(); ++i) add_rod(i);
    corner_.body_count = static_cast<int>(layout_.bodies.size()) - corner_.first_body;
    corner_.spring_upper = make_mount(suspension_.spring_upper);
    corner_.spring_lower = make_mount(suspension_.spring_lower);
    corner_.damper_upper = make_mount(suspension_.damper_upper);
    corner_.damper_lower = make_mount(suspension_.damper_lower);
  }

 private:
  /// Specification point of the left corner -> chassis axes of this corner.
  Vector3d place(const Vec3<double>& p) const {
    return reference_ + mirror_.cwiseProduct(to_eigen(p));
  }

  Vector3d from_center(int body, const Vector3d& p) const {
    return p - layout_.centers[static_cast<std::size_t>(body)];
  }

  int add_body(double mass, const Vector3d& center, const Matrix3d& inertia,
               const Vector3d& rod_axis = Vector3d::Zero()) {
    if (!(mass > 0.0)) {
      throw std::invalid_argument("full-coordinate model: every moving part needs mass > 0, got " +
                                  std::to_string(mass));
    }
    layout_.bodies.push_back({mass, inertia, rod_axis});
    layout_.centers.push_back(center);
    return static_cast<int>(layout_.bodies.size()) - 1;
  }

  int add_body(const BodySpec& body) {
    const Matrix3d mirror = mirror_.asDiagonal();
    return add_body(body.mass, place(body.center_of_mass),
                    mirror * to_eigen(body.inertia) * mirror);
  }

  void join_points(int a, int b, const Vector3d& p) {
    corner_.joints.push_back(make_coincident(a, b, from_center(a, p), from_center(b, p)));
  }

  /// Common axis through p: five equations.
  void join_axis(int a, int b, const Vector3d& p, const Vector3d& axis) {
    join_points(a, b, p);
    for (const Vector3d& n : make_normals(axis)) {
      corner_.joints.push_back(make_perpendicular(a, b, n, axis));
    }
  }

  /// Point p of body b stays on the line through p along `axis` of body a: two equations.
  void join_line(int a, int b, const Vector3d& p, const Vector3d& axis) {
    for (const Vector3d& n : make_normals(axis)) {
      corner_.joints.push_back(make_projection(a, b, n, from_center(a, p), from_center(b, p), 0));
    }
  }

  void join_orientation(int a, int b) {
    for (int i = 0; i < 3; ++i) {
      corner_.joints.push_back(
          make_perpendicular(a, b, Vector3d::Unit(i), Vector3d::Unit((i + 1) % 3)));
    }
  }

  /// Toe turns the front of the wheel inwards, camber its top outwards; to the left on both sides.
  Vector3d make_spin_axis() const {
    const double toe = suspension_.static_toe, camber = suspension_.static_camber;
    const Vector3d left(std::sin(toe) * std::cos(camber), std::cos(toe) * std::cos(camber),
                        -std::sin(camber));
    return mirror_.y() * mirror_.cwiseProduct(left);
  }

  void add_upright_and_wheel() {
    corner_.upright = add_body(suspension_.upright);
    corner_.wheel_center = place({0.0, suspension_.wheel_center_y, 0.0});
    corner_.spin_axis = make_spin_axis();
    const Vector3d& u = corner_.spin_axis;
    const double transverse = suspension_.wheel_transverse_inertia;
    const Matrix3d inertia = transverse * Matrix3d::Identity() +
                             (suspension_.wheel_spin_inertia - transverse) * u * u.transpose();
    corner_.wheel = add_body(suspension_.wheel_mass, corner_.wheel_center, inertia);
    join_axis(corner_.upright, corner_.wheel, corner_.wheel_center, u);
  }

  void add_macpherson() {
    const Vector3d front = place(suspension_.arm_front), rear = place(suspension_.arm_rear);
    const Vector3d top = place(suspension_.strut_top), bottom = place(suspension_.strut_bottom);
    arm_ = add_body(suspension_.lower_arm);
    join_axis(0, arm_, front, (rear - front).normalized());
    join_points(arm_, corner_.upright, place(suspension_.ball_joint));
    const Vector3d down = (bottom - top).normalized();
    if (suspension_.strut_rod.mass > 0.0) {
      const int rod = add_body(suspension_.strut_rod);
      join_points(0, rod, top);
      join_orientation(corner_.upright, rod);
      join_line(corner_.upright, rod, top, down);
    } else {
      join_line(corner_.upright, 0, top, down);
    }
    const int upright = corner_.upright;
    corner_.coordinate = make_projection(upright, 0, down, from_center(upright, bottom),
                                         from_center(0, top), (bottom - top).norm());
  }

  void add_multilink() {
    const int upright = corner_.upright;
    const Vector3d& c = corner_.wheel_center;
    corner_.coordinate = make_projection(0, upright, Vector3d::UnitZ(), from_center(0, c),
                                         from_center(upright, c), 0.0);
  }

  /// A rod is a body between two ball joints. Its inertia about its own axis cannot matter while it
  /// does not spin about it; the transverse value makes the tensor isotropic.
  void add_rod(std::size_t index) {
    const RodSpec& rod = suspension_.rods[index];
    const Vector3d a = place(rod.chassis), b = place(rod.upright);
    const double length = (b - a).norm();
    const double transverse =
        rod.transverse_inertia < 0.0 ? rod.mass * length * length / 12.0 : rod.transverse_inertia;
    const int body = add_body(rod.mass, a + rod.center_fraction * (b - a),
                              transverse * Matrix3d::Identity(), (b - a) / length);
    rods_.push_back(body);
    if (steered_ && static_cast<int>(index) == suspension_.tie_rod) {
      corner_.steered_joint = static_cast<int>(corner_.joints.size());
    }
    join_points(0, body, a);
    join_points(corner_.upright, body, b);
  }

  MountPoint make_mount(const MountSpec& mount) const {
    const Vector3d p = place(mount.position);
    switch (mount.body) {
      case MountBody::kChassis:
        return {0, from_center(0, p)};
      case MountBody::kUpright:
        return {corner_.upright, from_center(corner_.upright, p)};
      case MountBody::kLowerArm:
        if (arm_ < 0)
          throw std::invalid_argument("full-coordinate model: no lower arm to mount on");
        return {arm_, from_center(arm_, p)};
      case MountBody::kRod:
        break;
    }
    const int body = rods_.at(static_cast<std::size_t>(mount.rod));
    const Vector3d& axis = layout_.bodies[static_cast<std::size_t>(body)].rod_axis;
    const Vector3d arm = from_center(body, p);
    if (axis.cross(arm).norm() > 1e-9) {
      throw std::invalid_argument("full-coordinate model: a mount beside the line of its rod");
    }
    return {body, arm};
  }

  const SuspensionSpec& suspension_;
  Vector3d mirror_;
  CarLayout& layout_;
  CornerLayout& corner_;
  Vector3d reference_ = Vector3d::Zero();
  bool steered_ = false;
  int arm_ = -1;
  std::vector<int> rods_;
};

/// Inertia of a body's mass distribution about its center; a rod has none about its own axis.
Matrix3d calc_true_inertia(const RigidBody& body) {
  const Vector3d& e = body.rod_axis;
  return body.inertia - body.inertia * e * e.transpose();
}

/// The body that completes the others to the whole car.
RigidBody make_chassis(const WholeCarSpec& whole, const CarLayout& layout, Vector3d* center) {
  RigidBody chassis{whole.mass, to_eigen(whole.inertia), Vector3d::Zero()};
  Vector3d moment = Vector3d::Zero();
  for (std::size_t k = 1; k < layout.bodies.size(); ++k) {
    const RigidBody& body = layout.bodies[k];
    chassis.mass -= body.mass;
    moment -= body.mass * layout.centers[k];
    chassis.inertia -= calc_true_inertia(body) + make_point_inertia(body.mass, layout.centers[k]);
  }
  *center = moment / chassis.mass;
  chassis.inertia -= make_point_inertia(chassis.mass, *center);
  if (!(chassis.mass > 0.0) || chassis.inertia.llt().info() != Eigen::Success) {
    throw std::invalid_argument(
        "full-coordinate model: the parts outweigh the car, nothing is left for the chassis");
  }
  return chassis;
}

/// Chassis points were taken from the chassis origin, its center of mass being unknown until now.
void shift_chassis_points(const Vector3d& center, CornerLayout* corner) {
  const auto shift = [&center](Joint* joint) {
    if (joint->a == 0) joint->point_a -= center;
    if (joint->b == 0) joint->point_b -= center;
  };
  for (Joint& joint : corner->joints) shift(&joint);
  shift(&corner->coordinate);
  for (MountPoint* mount : {&corner->spring_upper, &corner->spring_lower, &corner->damper_upper,
                            &corner->damper_lower}) {
    if (mount->body == 0) mount->s -= center;
  }
}

}  // namespace

CarLayout make_layout(const VehicleSpec& spec, double gravity) {
  CarLayout layout;
  layout.bodies.emplace_back();
  layout.centers.emplace_back(Vector3d::Zero());
  for (int corner = 0; corner < kCorners; ++corner) {
    CornerBuilder(spec, corner, gravity, &layout).build();
  }
  layout.bodies[0] = make_chassis(spec.whole, layout, &layout.centers[0]);
  for (CornerLayout& corner : layout.corners) shift_chassis_points(layout.centers[0], &corner);
  return layout;
}

}  // namespace strut::reference
