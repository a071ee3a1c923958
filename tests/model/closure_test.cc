// A corner's loops and motion functions: closure, derivatives, mirror images, refusals. The masses
// behind them: composite_test.cc.

#include "model/multibody/closure.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "tests/model/test_corner.h"

namespace strut {
namespace {

using test::append;
using test::calc_motion;
using test::calc_pose;
using test::differentiate;
using test::make_car;
using test::make_paper_car;
using test::make_travels;
using test::mirror;
using test::Motion;
using test::place;
using test::tolerance;

TEST_CASE("One Newton iteration closes every corner over its travel", "[unit][property]") {
  VehicleSpec steered = reference::make_paper_sedan_spec();
  steered.rack_position = 0.01;
  for (const VehicleSpec& spec : {reference::make_paper_sedan_spec(), steered}) {
    const AssembledVehicle car = make_car(spec);
    const NewtonClosure<double> closure{&car.layout, &car.numbers};
    double worst = 0.0;
    for (int corner = 0; corner < kCorners; ++corner) {
      for (const double q : make_travels(401)) {
        Motion motion{};
        worst = std::max(worst, closure(corner, q, motion));
      }
    }
    INFO("largest loop error " << worst << " m");
    CHECK(worst < tolerance(2e-14));  // rounding; the predictor alone leaves 1e-12
  }
}

void check_zero(const Vec3<double>& r, double allowed) { CHECK(norm(r) < tolerance(allowed)); }

TEST_CASE("A MacPherson corner keeps its rod, ball joint, slide and arm axis", "[unit][property]") {
  const VehicleSpec spec = reference::make_paper_sedan_spec();
  const SuspensionSpec& front = spec.suspension[kFront];
  const AssembledVehicle car = make_car(spec);
  for (const int corner : {kFrontLeft, kFrontRight}) {
    const auto at = [&](const Vec3<double>& r) { return place(car, corner, r); };
    for (const double q : make_travels(41)) {
      const CornerPose<double> pose = calc_pose(car, corner, q);
      const Displacement<double>&arm = pose.part[0], &upright = pose.part[4];
      // Rounding of a few products of lengths below 1 m.
      constexpr double kRounding = 1e-12;
      const RodSpec& rod = front.rods[0];
      CHECK(std::abs(norm(upright.apply(at(rod.upright)) - at(rod.chassis)) -
                     norm(rod.upright - rod.chassis)) < tolerance(kRounding));
      check_zero(upright.apply(at(front.ball_joint)) - arm.apply(at(front.ball_joint)), kRounding);
      check_zero(arm.apply(at(front.arm_front)) - at(front.arm_front), kRounding);
      check_zero(arm.apply(at(front.arm_rear)) - at(front.arm_rear), kRounding);
      // The upright's slide line runs through the strut top, q nearer to it.
      const Vec3<double> top = at(front.strut_top);
      const Vec3<double> bottom = upright.apply(at(front.strut_bottom));
      CHECK(std::abs(norm(front.strut_top - front.strut_bottom) - norm(top - bottom) - q) <
            tolerance(kRounding));
      const Vec3<double> line = upright.apply(top) - bottom;
      check_zero(cross(normalized(line), top - bottom), kRounding);
    }
  }
}

TEST_CASE("A multilink corner keeps its five rods, and q is the wheel's rise", "[unit][property]") {
  const VehicleSpec spec = reference::make_paper_sedan_spec();
  const AssembledVehicle car = make_car(spec);
  for (const int corner : {kRearLeft, kRearRight}) {
    for (const double q : make_travels(41)) {
      const CornerPose<double> pose = calc_pose(car, corner, q);
      const Displacement<double>& upright = pose.part[5];
      for (const RodSpec& rod : spec.suspension[kRear].rods) {
        const Vec3<double> end = upright.apply(place(car, corner, rod.upright));
        CHECK(std::abs(norm(end - place(car, corner, rod.chassis)) -
                       norm(rod.upright - rod.chassis)) < tolerance(1e-12));
      }
      const Vec3<double>& center = car.numbers.geometry[corner].wheel_center;
      CHECK(std::abs(upright.apply(center).z - center.z - q) < tolerance(1e-15));
    }
  }
}

/// Functions of q and, in the same order, what the model says are their derivatives.
std::vector<double> list_functions(const Motion& m) {
  std::vector<double> f;
  for (const auto& v : {m.moment, m.moment_q, m.coupling, m.center, m.center_q, m.axis})
    append(f, v);
  append(f, m.inertia);
  f.insert(f.end(), {m.mass, m.length[0], m.length[1]});
  return f;
}
std::vector<double> list_slopes(const Motion& m) {
  std::vector<double> f;
  for (const auto& v : {m.moment_q, m.moment_qq, m.coupling_q, m.center_q, m.center_qq, m.axis_q}) {
    append(f, v);
  }
  append(f, m.inertia_q);
  f.insert(f.end(), {m.mass_q, m.length_q[0], m.length_q[1]});
  return f;
}

TEST_CASE("Derivatives of the motion functions are those of their values", "[unit][property]") {
  const AssembledVehicle car = make_paper_car();
  double worst = 0.0;
  for (int corner = 0; corner < kCorners; ++corner) {
    for (const double q : {-0.08, -0.03, 0.0, 0.041, 0.09}) {
      const auto functions = [&](double at) {
        return list_functions(calc_motion(car, corner, at));
      };
      const std::vector<double> truth = differentiate(functions, q, 1e-3);
      const std::vector<double> slopes = list_slopes(calc_motion(car, corner, q));
      for (std::size_t i = 0; i < truth.size(); ++i) {
        worst = std::max(worst, std::abs(slopes[i] - truth[i]) / (1.0 + std::abs(truth[i])));
      }
    }
  }
  INFO("worst relative difference " << worst);
  // Rounding of values of order ten over 1 mm, and h^6 / 140 times a seventh derivative.
  CHECK(worst < tolerance(1e-10));
}

TEST_CASE("The upright turns with its angular velocity", "[unit][property]") {
  const AssembledVehicle car = make_paper_car();
  for (int corner = 0; corner < kCorners; ++corner) {
    const auto columns = [&](double q) {
      const int upright = get_tree(car.layout.corner[corner].kind).upright;
      const Mat3<double> r = calc_pose(car, corner, q).part[upright].rotation;
      std::vector<double> list;
      for (const auto& column : {r.x, r.y, r.z}) append(list, column);
      return list;
    };
    constexpr double q = 0.037;
    const std::vector<double> r = columns(q), r_q = differentiate(columns, q, 1e-3);
    const Vec3<double> w = calc_motion(car, corner, q).upright_rate;
    for (std::size_t i = 0; i < 9; i += 3) {
      const Vec3<double> column{r[i], r[i + 1], r[i + 2]}, rate{r_q[i], r_q[i + 1], r_q[i + 2]};
      check_zero(cross(w, column) - rate, 1e-11);  // rounding over 1 mm
    }
  }
}

TEST_CASE("The right corner mirrors the left", "[unit][property]") {
  const AssembledVehicle car = make_paper_car();
  const auto axial = [](const Vec3<double>& w) { return Vec3<double>{-w.x, w.y, -w.z}; };
  constexpr double kRounding = 1e-12;
  for (const int left : {kFrontLeft, kRearLeft}) {
    for (const double q : make_travels(21)) {
      const Motion l = calc_motion(car, left, q), r = calc_motion(car, left + 1, q);
      check_zero(mirror(l.moment) - r.moment, kRounding);
      check_zero(mirror(l.moment_qq) - r.moment_qq, 1e-10);
      check_zero(mirror(l.center) - r.center, kRounding);
      check_zero(axial(l.axis) - r.axis, kRounding);
      check_zero(axial(l.coupling) - r.coupling, kRounding);
      check_zero(axial(l.upright_rate) - r.upright_rate, 1e-11);
      CHECK(std::abs(l.inertia.xy + r.inertia.xy) < tolerance(kRounding));
      CHECK(std::abs(l.inertia.xz - r.inertia.xz) < tolerance(kRounding));
      CHECK(std::abs(l.inertia.yz + r.inertia.yz) < tolerance(kRounding));
      CHECK(std::abs(l.mass - r.mass) < tolerance(1e-11));
      CHECK(std::abs(l.length[0] - r.length[0]) < tolerance(kRounding));
    }
  }
}

/// Message with which the assembly of `spec` fails; empty if it succeeds.
std::string find_refusal(const VehicleSpec& spec) {
  try {
    make_car(spec);
  } catch (const ModelError& e) {
    return e.what();
  }
  return "";
}

TEST_CASE("Hardpoints that cannot close are refused with axle and travel", "[unit]") {
  using Catch::Contains;
  VehicleSpec spec = reference::make_paper_sedan_spec();
  SuspensionSpec& front = spec.suspension[kFront];
  front.arm_front = front.ball_joint + Vec3<double>{0.1, -0.06, 0.0};  // an arm of 60 mm
  front.arm_rear = front.ball_joint + Vec3<double>{-0.1, -0.06, 0.0};
  CHECK_THAT(find_refusal(spec), Contains("front_suspension") && Contains("mm of travel"));

  spec = reference::make_paper_sedan_spec();
  RodSpec& link = spec.suspension[kRear].rods[2];
  link.chassis = link.upright + Vec3<double>{0.0, -0.05, 0.0};
  CHECK_THAT(find_refusal(spec), Contains("rear_suspension") && Contains("mm of travel"));
}

TEST_CASE("Mechanisms that do not guide the wheel are refused", "[unit]") {
  using Catch::Contains;
  VehicleSpec spec = reference::make_paper_sedan_spec();
  spec.suspension[kRear].rods[1] = spec.suspension[kRear].rods[0];  // two rods in one place
  CHECK_THAT(find_refusal(spec), Contains("singular"));

  spec = reference::make_paper_sedan_spec();
  spec.suspension[kRear].rods.pop_back();
  CHECK_THAT(find_refusal(spec), Contains("4 rods") && Contains("allowed: 5"));
  spec = reference::make_paper_sedan_spec();
  spec.suspension[kFront].rods.clear();
  CHECK_THAT(find_refusal(spec), Contains("0 rods") && Contains("allowed: 1"));

  spec = reference::make_paper_sedan_spec();
  spec.suspension[kRear].spring_lower.body = MountBody::kLowerArm;
  CHECK_THAT(find_refusal(spec), Contains("lower_arm"));
  spec = reference::make_paper_sedan_spec();
  spec.suspension[kRear].spring_lower = {MountBody::kChassis, 0, {0.0, 0.5, -0.1}};
  CHECK_THAT(find_refusal(spec), Contains("rear_suspension.spring"));
}

}  // namespace
}  // namespace strut
