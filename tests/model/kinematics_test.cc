#include "model/car/kinematics.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

#include "io/table/csv.h"
#include "tests/model/test_corner.h"
#include "tests/support/test_car.h"

namespace strut {
namespace {

using test::tolerance;

/// The curve's ten digits: 5e-12 rad, 5e-11 m. What is asked of the car is 1e-8.
constexpr double kTolerance = 1e-10;

std::vector<double> list_travels() {
  std::vector<double> travels;
  for (int i = -40; i <= 40; ++i) travels.push_back(i / 400.0);
  return travels;
}

/// The sedan with the front hardpoints of Chrono's generic MacPherson strut.
VehicleSpec make_generic_strut() {
  VehicleSpec spec = reference::make_paper_sedan_spec();
  SuspensionSpec& front = spec.suspension[kFront];
  const Vec3<double> center{-0.04000403, 0.0, -0.02602507};
  front.arm_front = Vec3<double>{0.220, 0.520, -0.156} - center;
  front.arm_rear = Vec3<double>{-0.300, 0.507, -0.137} - center;
  front.ball_joint = Vec3<double>{-0.02165371, 0.94057703, -0.17402826} - center;
  front.rods[0].chassis = Vec3<double>{-0.300, 0.520, -0.059} - center;
  front.rods[0].upright = Vec3<double>{-0.2373756, 0.89495045, -0.01605418} - center;
  front.strut_top = Vec3<double>{-0.115, 0.785, 0.579} - center;
  front.strut_bottom = Vec3<double>{-0.07402507, 0.8532915, 0.2484536} - center;
  front.wheel_center_y = 1.09999965;
  front.static_toe = front.static_camber = 0.0;
  front.spring_upper.position = front.damper_upper.position = front.strut_top;
  front.spring_lower.position = front.damper_lower.position = front.strut_bottom;
  return spec;
}

/// A point's numbers in the order of the reference's columns.
std::vector<double> list_values(const KinematicsPoint& p) {
  return {p.travel,         p.camber,        p.toe,           p.displacement.x, p.displacement.y,
          p.displacement.z, p.caster_change, p.spring_length, p.damper_length};
}

TEST_CASE("The front corner follows the independent curve over +-100 mm in every column",
          "[unit][reference]") {
  const CsvTable reference = read_csv(STRUT_SOURCE_DIR "/tests/data/macpherson_kinematics.csv");
  const AssembledVehicle car = assemble_vehicle(make_generic_strut(), ManeuverSpec{});
  const auto points = calc_kinematics(car, kFrontLeft, list_travels());
  REQUIRE(reference.row_count() == points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::vector<double> values = list_values(points[i]);
    for (std::size_t column = 0; column < values.size(); ++column) {
      INFO(reference.columns[column].name << " at " << 1e3 * points[i].travel << " mm");
      CHECK(std::abs(values[column] - reference.columns[column].values[i]) < tolerance(kTolerance));
    }
  }
}

TEST_CASE("Left and right corner mirror each other", "[unit][property]") {
  const AssembledVehicle car = assemble_vehicle(reference::make_paper_sedan_spec(), ManeuverSpec{});
  for (const int left : {kFrontLeft, kRearLeft}) {
    const auto a = calc_kinematics(car, left, list_travels());
    const auto b = calc_kinematics(car, left + 1, list_travels());
    for (std::size_t i = 0; i < a.size(); ++i) {
      // Newton leaves 1e-13 m; angles are that over 0.1 m.
      CHECK(std::abs(a[i].camber - b[i].camber) < tolerance(1e-11));
      CHECK(std::abs(a[i].toe - b[i].toe) < tolerance(1e-11));
      CHECK(std::abs(a[i].displacement.y + b[i].displacement.y) < tolerance(1e-12));
      CHECK(std::abs(a[i].caster_change - b[i].caster_change) < tolerance(1e-11));
      CHECK(std::abs(a[i].track - b[i].track) < tolerance(1e-12));
    }
  }
}

TEST_CASE("At nominal trim wheels have their static angles and the track of the file", "[unit]") {
  const VehicleSpec spec = reference::make_paper_sedan_spec();
  const AssembledVehicle car = assemble_vehicle(spec, ManeuverSpec{});
  for (const int corner : {kFrontLeft, kFrontRight, kRearLeft, kRearRight}) {
    const SuspensionSpec& suspension = spec.suspension[axle_of(corner)];
    const KinematicsPoint p = calc_kinematics(car, corner, {0.0}).front();
    CHECK(p.toe == Approx(suspension.static_toe).epsilon(tolerance(1e-12)));
    CHECK(p.camber == Approx(suspension.static_camber).epsilon(tolerance(1e-12)));
    CHECK(p.track == Approx(2.0 * suspension.wheel_center_y).epsilon(tolerance(1e-14)));
    CHECK(std::abs(p.caster_change) < tolerance(1e-14));
    CHECK(norm(p.displacement) < tolerance(1e-14));
  }
}

TEST_CASE("The rear corner follows the closure the equations of motion use", "[unit][property]") {
  const AssembledVehicle car = assemble_vehicle(reference::make_paper_sedan_spec(), ManeuverSpec{});
  const NewtonClosure<double> closure{&car.layout, &car.numbers};
  const std::vector<double> travels = list_travels();
  const auto points = calc_kinematics(car, kRearLeft, travels);
  for (std::size_t i = 0; i < travels.size(); ++i) {
    CornerMotion<double> motion;
    closure(kRearLeft, travels[i], motion);  // the multilink's coordinate is the wheel's rise
    const Vec3<double> moved =
        car.numbers.geometry[kRearLeft].wheel_center + points[i].displacement;
    CHECK(norm(motion.center - moved) < tolerance(1e-11));
    CHECK(std::abs(motion.length[kSpringLine] - points[i].spring_length) < tolerance(1e-11));
  }
}

TEST_CASE("A spring beside the line of its rod follows the rod's shortest rotation",
          "[unit][reference]") {
  VehicleSpec spec = reference::make_paper_sedan_spec();
  SuspensionSpec& rear = spec.suspension[kRear];
  constexpr int kRod = 3;
  const RodSpec& rod = rear.rods[kRod];
  rear.spring_lower = {MountBody::kRod, kRod,
                       0.6 * rod.chassis + 0.4 * rod.upright + Vec3<double>{0.04, -0.03, 0.11}};
  const AssembledVehicle car = test::make_car(spec);
  const CornerGeometry<double>& geometry = car.numbers.geometry[kRearLeft];
  const auto to_eigen = [](const Vec3<double>& v) { return Eigen::Vector3d(v.x, v.y, v.z); };
  const Eigen::Vector3d chassis = to_eigen(geometry.rod_chassis[kRod]);
  const Eigen::Vector3d before = to_eigen(geometry.rod_upright[kRod]) - chassis;
  const Eigen::Vector3d mount = to_eigen(test::place(car, kRearLeft, rear.spring_lower.position));
  const Eigen::Vector3d upper = to_eigen(test::place(car, kRearLeft, rear.spring_upper.position));
  double moved = 0.0;
  for (const double q : test::make_travels(9)) {
    const CornerPose<double> pose = test::calc_pose(car, kRearLeft, q);
    const Eigen::Vector3d after = to_eigen(pose.rod_end[kRod]) - chassis;
    const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(before, after);
    const Eigen::Vector3d lower = chassis + turn * (mount - chassis);
    const test::Motion motion = test::calc_motion(car, kRearLeft, q);
    CHECK(motion.length[kSpringLine] == Approx((upper - lower).norm()).margin(tolerance(1e-12)));
    constexpr double kStep = 1e-5;  // central difference: 1e-10 of it by the third derivative
    const double slope = (test::calc_motion(car, kRearLeft, q + kStep).length[kSpringLine] -
                          test::calc_motion(car, kRearLeft, q - kStep).length[kSpringLine]) /
                         (2.0 * kStep);
    CHECK(motion.length_q[kSpringLine] == Approx(slope).margin(tolerance(1e-8)));
    const double on_line =
        (upper - chassis - (mount - chassis).dot(before) / before.squaredNorm() * after).norm();
    moved = std::max(moved, std::abs(on_line - motion.length[kSpringLine]));
  }
  CHECK(moved > 0.05);  // a projected mount would differ by this
}

TEST_CASE("Travel beyond what the links allow is an error that names axle and travel", "[unit]") {
  const AssembledVehicle car = assemble_vehicle(reference::make_paper_sedan_spec(), ManeuverSpec{});
  std::vector<double> travels;
  for (int i = 0; i <= 400; ++i) travels.push_back(i / 400.0);
  CHECK_THROWS_WITH(calc_kinematics(car, kRearLeft, travels),
                    Catch::Matchers::Contains("rear_suspension") &&
                        Catch::Matchers::Contains("mm of wheel travel"));
}

}  // namespace
}  // namespace strut
