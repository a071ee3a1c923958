// A corner's composite against a sum over its displaced bodies and rods.

#include <algorithm>
#include <catch2/catch.hpp>
#include <vector>

#include "tests/model/test_corner.h"

namespace strut {
namespace {

using test::append;
using test::calc_motion;
using test::calc_pose;
using test::differentiate;
using test::make_car;
using test::make_travels;
using test::Motion;
using test::place;
using test::tolerance;

/// Masses on points of the corner at one q, chassis axes, and rotated inertias.
struct Sum {
  double mass = 0.0;
  Vec3<double> moment{};
  Sym3<double> inertia{};
};

void add_point(Sum& sum, double mass, const Vec3<double>& r) {
  const double x = r.x, y = r.y, z = r.z;
  sum.mass += mass;
  sum.moment += mass * r;
  sum.inertia += {mass * (y * y + z * z), mass * (x * x + z * z), mass * (x * x + y * y),
                  -mass * x * y,          -mass * x * z,          -mass * y * z};
}

/// A rod as points: Gauss's three, exact for the quadratic density that has the rod's mass, center
/// and transverse inertia. s runs from -1 at the chassis end to 1.
struct RodPoints {
  std::array<double, 3> mass{};
  std::array<double, 3> fraction{};  // from the chassis end
};

RodPoints make_rod_points(const RodSpec& rod) {
  const double length = norm(rod.upright - rod.chassis);
  const double center = 2.0 * rod.center_fraction - 1.0;
  const double central = rod.transverse_inertia < 0.0
                             ? rod.mass / 3.0
                             : rod.transverse_inertia * 4.0 / (length * length);
  const double first = rod.mass * center, second = central + rod.mass * center * center;
  // Moments of density c0 + c1 s + c2 s^2 over [-1, 1]: 2 c0 + 2/3 c2, 2/3 c1, 2/3 c0 + 2/5 c2.
  const double c1 = 1.5 * first;
  const double c2 = (second - rod.mass / 3.0) / (2.0 / 5.0 - 2.0 / 9.0);
  const double c0 = 0.5 * rod.mass - c2 / 3.0;
  RodPoints points;
  const double nodes[] = {-std::sqrt(0.6), 0.0, std::sqrt(0.6)};
  const double weights[] = {5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0};
  for (std::size_t i = 0; i < 3; ++i) {
    points.mass[i] = weights[i] * (c0 + nodes[i] * (c1 + nodes[i] * c2));
    points.fraction[i] = 0.5 * (1.0 + nodes[i]);
  }
  return points;
}

/// A body of the specification and the part of the tree it is fixed to.
struct PlacedBody {
  BodySpec body;
  int part = 0;
};

/// The wheel as its carrier feels it: no inertia about the spin axis (left corner).
BodySpec make_wheel(const SuspensionSpec& axle) {
  const double toe = axle.static_toe, camber = axle.static_camber;
  const Vec3<double> u{std::sin(toe) * std::cos(camber), std::cos(toe) * std::cos(camber),
                       -std::sin(camber)};
  const double i = axle.wheel_transverse_inertia;
  return {axle.wheel_mass,
          {0.0, axle.wheel_center_y, 0.0},
          {i * (1.0 - u.x * u.x), i * (1.0 - u.y * u.y), i * (1.0 - u.z * u.z), -i * u.x * u.y,
           -i * u.x * u.z, -i * u.y * u.z}};
}

std::vector<PlacedBody> list_bodies(const SuspensionSpec& axle) {
  if (axle.kind == SuspensionKind::kMultilink) return {{axle.upright, 5}, {make_wheel(axle), 5}};
  return {{axle.upright, 4}, {make_wheel(axle), 4}, {axle.lower_arm, 0}, {axle.strut_rod, 3}};
}

/// R S R^T by its nine columns, without the model's formulas.
Sym3<double> turn(const Mat3<double>& r, const Sym3<double>& s) {
  const double m[3][3] = {{s.xx, s.xy, s.xz}, {s.xy, s.yy, s.yz}, {s.xz, s.yz, s.zz}};
  const double q[3][3] = {{r.x.x, r.y.x, r.z.x}, {r.x.y, r.y.y, r.z.y}, {r.x.z, r.y.z, r.z.z}};
  double out[3][3] = {};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      for (int k = 0; k < 3; ++k) {
        for (int l = 0; l < 3; ++l) out[i][j] += q[i][k] * m[k][l] * q[j][l];
      }
    }
  }
  return {out[0][0], out[1][1], out[2][2], out[0][1], out[0][2], out[1][2]};
}

/// Everything of a left corner at q that has mass.
struct MassPoints {
  std::vector<double> mass;
  std::vector<Vec3<double>> place;     // mass points: centers of bodies, points on rods
  std::vector<Sym3<double>> inertia;   // by body, in chassis axes
  std::vector<Mat3<double>> rotation;  // by body
};

MassPoints place_masses(const VehicleSpec& spec, const AssembledVehicle& car, int corner,
                        double q) {
  const SuspensionSpec& axle = spec.suspension[axle_of(corner)];
  const CornerPose<double> pose = calc_pose(car, corner, q);
  MassPoints points;
  for (const PlacedBody& b : list_bodies(axle)) {
    const Displacement<double>& part = pose.part[b.part];
    points.mass.push_back(b.body.mass);
    points.place.push_back(part.apply(place(car, corner, b.body.center_of_mass)));
    points.inertia.push_back(turn(part.rotation, b.body.inertia));
    points.rotation.push_back(part.rotation);
  }
  const Displacement<double>& upright = pose.part[get_tree(axle.kind).upright];
  for (const RodSpec& rod : axle.rods) {
    const RodPoints on_rod = make_rod_points(rod);
    const Vec3<double> inner = place(car, corner, rod.chassis);
    const Vec3<double> outer = upright.apply(place(car, corner, rod.upright));
    for (std::size_t i = 0; i < 3; ++i) {
      points.mass.push_back(on_rod.mass[i]);
      points.place.push_back(inner + on_rod.fraction[i] * (outer - inner));
    }
  }
  return points;
}

double measure_difference(const Vec3<double>& a, const Vec3<double>& b) {
  return norm(a - b) / (1.0 + norm(b));
}

TEST_CASE("The composite's moment and inertia are the sum over bodies and rods",
          "[unit][property]") {
  const VehicleSpec spec = reference::make_paper_sedan_spec();
  const AssembledVehicle car = make_car(spec);
  for (const int corner : {kFrontLeft, kRearLeft}) {
    for (const double q : make_travels(9)) {
      const MassPoints points = place_masses(spec, car, corner, q);
      Sum sum;
      for (std::size_t i = 0; i < points.mass.size(); ++i) {
        add_point(sum, points.mass[i], points.place[i]);
      }
      for (const Sym3<double>& j : points.inertia) sum.inertia += j;
      const Motion motion = calc_motion(car, corner, q);
      // Rounding of sums of order 50 kg m and kg m^2.
      CHECK(measure_difference(motion.moment, sum.moment) < tolerance(1e-13));
      const Sym3<double> d = motion.inertia - sum.inertia;
      for (const double part : {d.xx, d.yy, d.zz, d.xy, d.xz, d.yz}) {
        CHECK(std::abs(part) < tolerance(1e-12));
      }
    }
  }
}

TEST_CASE("The composite's momenta and energy are the sum over moving bodies and rods",
          "[unit][property]") {
  const VehicleSpec spec = reference::make_paper_sedan_spec();
  const AssembledVehicle car = make_car(spec);
  for (const int corner : {kFrontLeft, kRearLeft}) {
    for (const double q : {-0.07, 0.0, 0.02, 0.085}) {
      // Velocities per unit q_dot are differences of places; turning rates of rotations.
      const auto list = [&](double at) {
        const MassPoints points = place_masses(spec, car, corner, at);
        std::vector<double> all;
        for (const Vec3<double>& r : points.place) append(all, r);
        for (const Mat3<double>& r : points.rotation) {
          for (const auto& column : {r.x, r.y, r.z}) append(all, column);
        }
        return all;
      };
      const std::vector<double> rate = differentiate(list, q, 1e-3);
      const auto get = [&](std::size_t i) {
        return Vec3<double>{rate[3 * i], rate[3 * i + 1], rate[3 * i + 2]};
      };
      const MassPoints points = place_masses(spec, car, corner, q);
      Vec3<double> linear{}, angular{};
      double energy2 = 0.0;
      const std::size_t count = points.mass.size();
      for (std::size_t i = 0; i < count; ++i) {
        linear += points.mass[i] * get(i);
        angular += points.mass[i] * cross(points.place[i], get(i));
        energy2 += points.mass[i] * dot(get(i), get(i));
      }
      for (std::size_t b = 0; b < points.rotation.size(); ++b) {
        // Columns c_i turn at w x c_i, so w is half the sum of c_i x c_i'.
        const Mat3<double>& r = points.rotation[b];
        const std::size_t at = count + 3 * b;
        const Vec3<double> w =
            0.5 * (cross(r.x, get(at)) + cross(r.y, get(at + 1)) + cross(r.z, get(at + 2)));
        angular += points.inertia[b] * w;
        energy2 += dot(w, points.inertia[b] * w);
      }
      const Motion motion = calc_motion(car, corner, q);
      // Rounding of places over steps of 1 mm.
      CHECK(measure_difference(motion.moment_q, linear) < tolerance(1e-11));
      CHECK(measure_difference(motion.coupling, angular) < tolerance(1e-11));
      CHECK(std::abs(motion.mass - energy2) < tolerance(1e-11) * energy2);
    }
  }
}

TEST_CASE("The whole car at nominal trim has the mass, centroid and inertia of its specification",
          "[unit]") {
  const VehicleSpec spec = reference::make_paper_sedan_spec();
  const AssembledVehicle car = make_car(spec);
  const RigidBody<double>& chassis = car.numbers.chassis;
  Sum sum;
  add_point(sum, chassis.mass, chassis.center);
  sum.inertia += chassis.inertia;
  for (int corner = 0; corner < kCorners; ++corner) {
    const SuspensionSpec& axle = spec.suspension[axle_of(corner)];
    const Motion motion = calc_motion(car, corner, 0.0);
    for (const PlacedBody& b : list_bodies(axle)) sum.mass += b.body.mass;
    for (const RodSpec& rod : axle.rods) sum.mass += rod.mass;
    sum.moment += motion.moment;
    sum.inertia += motion.inertia;
    const double spin = axle.wheel_spin_inertia;
    const Vec3<double>& u = motion.axis;
    sum.inertia += {spin * u.x * u.x, spin * u.y * u.y, spin * u.z * u.z,
                    spin * u.x * u.y, spin * u.x * u.z, spin * u.y * u.z};
  }
  CHECK(std::abs(sum.mass - spec.whole.mass) < tolerance(1e-11));
  CHECK(norm(sum.moment) < tolerance(1e-11));
  const Sym3<double> d = sum.inertia - spec.whole.inertia;
  for (const double part : {d.xx, d.yy, d.zz, d.xy, d.xz, d.yz}) {
    CHECK(std::abs(part) < tolerance(1e-10));  // rounding of 1800 kg m^2
  }
}

}  // namespace
}  // namespace strut
