// The reference model against closed forms and conservation laws, before anything is compared with
// it.
#include "tests/reference/full_coordinate_car.h"

#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>

#include "tests/reference/reference_trajectory.h"
#include "tests/reference/sample_specs.h"

namespace strut::reference {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Numbers in [-1, 1), the same on every machine (splitmix64).
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  double operator()() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1.0;
  }
  Vector3d vector(double size) {
    const double x = (*this)(), y = (*this)(), z = (*this)();
    return size * Vector3d(x, y, z);
  }

 private:
  std::uint64_t state_;
};

FullCoordinateCar make_car(const VehicleSpec& spec, double torque = 0.0) {
  ManeuverSpec maneuver;
  maneuver.drive_torque = torque;
  return FullCoordinateCar(spec, maneuver, make_flat_road_laws(spec));
}

/// A wild but possible state near nominal trim at about 20 m/s.
ReducedState make_random_state(const FullCoordinateCar& car, std::uint64_t seed) {
  Random random(seed);
  ReducedState s = car.make_nominal();
  s.position += random.vector(0.03);
  s.quaternion.tail<3>() = random.vector(0.05);
  s.velocity = Vector3d(20.0, 0.0, 0.0) + random.vector(1.0);
  s.angular_velocity = random.vector(1.0);
  for (std::size_t i = 0; i < 4; ++i) {
    s.q[i] = 0.05 * random();
    s.q_dot[i] = random();
    s.spin[i] = s.velocity.x() / 0.46 * (1.0 + 0.03 * random());
  }
  return s;
}

constexpr double kRounding = 1e-9;  // relative; the equations' condition number times epsilon

struct Momentum {
  Vector3d force = Vector3d::Zero(), moment = Vector3d::Zero();  // about the world origin
};

Momentum calc_momentum_rate(const FullCoordinateCar& car, const ReferenceState& state) {
  const std::vector<Twist6> a = car.calc_body_accelerations(state);
  Momentum rate;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const RigidBody& body = car.layout().bodies[k];
    const Matrix3d inertia = rotate_inertia(body, state.bodies[k]);
    const Vector3d& w = state.bodies[k].angular_velocity;
    const Vector3d linear = body.mass * a[k].head<3>();
    rate.force += linear;
    rate.moment +=
        state.bodies[k].position.cross(linear) + inertia * a[k].tail<3>() + w.cross(inertia * w);
  }
  return rate;
}

Momentum calc_outer_forces(const FullCoordinateCar& car, const ReferenceState& state) {
  Momentum outer;
  for (std::size_t k = 0; k < state.bodies.size(); ++k) {
    const Vector3d weight(0.0, 0.0, -car.layout().bodies[k].mass * car.forces().gravity);
    outer.force += weight;
    outer.moment += state.bodies[k].position.cross(weight);
  }
  for (int corner = 0; corner < kCorners; ++corner) {
    const WheelContact contact = car.calc_contact(state, corner);
    outer.force += contact.force;
    outer.moment += contact.point.cross(contact.force) + contact.moment;
  }
  return outer;
}

double calc_energy_rate(const FullCoordinateCar& car, const ReferenceState& state) {
  const std::vector<Twist6> a = car.calc_body_accelerations(state);
  double rate = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const RigidBody& body = car.layout().bodies[k];
    const BodyState& s = state.bodies[k];
    rate += body.mass * s.velocity.dot(a[k].head<3>()) +
            s.angular_velocity.dot(rotate_inertia(body, s) * a[k].tail<3>()) +
            body.mass * car.forces().gravity * s.velocity.z();
  }
  for (int corner = 0; corner < kCorners; ++corner) {
    const LineElement spring = car.calc_spring(state, corner);
    rate -= spring.force * spring.rate;
  }
  return rate;
}

MatrixXd make_jacobian(const std::vector<ConstraintRow>& rows, std::size_t bodies) {
  MatrixXd j =
      MatrixXd::Zero(static_cast<Eigen::Index>(rows.size()), 6 * static_cast<Eigen::Index>(bodies));
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const auto row = static_cast<Eigen::Index>(r);
    j.block<1, 6>(row, 6 * rows[r].a) += rows[r].ja.transpose();
    j.block<1, 6>(row, 6 * rows[r].b) += rows[r].jb.transpose();
  }
  return j;
}

void move(double dt, BodyState* body) {
  body->position += dt * body->velocity;
  const double w = body->angular_velocity.norm();
  const Eigen::AngleAxisd turn(w * dt, body->angular_velocity / w);
  body->orientation = Eigen::Quaterniond(turn) * body->orientation;
}

}  // namespace

TEST_CASE("A constraint's rate and second derivative are those of its value", "[unit][reference]") {
  Random random(1);
  const auto unit = [&random] { return random.vector(1.0).normalized(); };
  const std::vector<Joint> joints = {
      make_coincident(0, 1, random.vector(1.0), random.vector(1.0)),
      make_perpendicular(0, 1, unit(), unit()),
      make_projection(0, 1, unit(), random.vector(1.0), random.vector(1.0), 0.3)};
  std::vector<BodyState> now(2);
  for (BodyState& body : now) {
    body.position = random.vector(1.0);
    body.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(1.0 + random(), unit()));
    body.velocity = random.vector(1.0);
    body.angular_velocity = random.vector(1.0);
  }
  constexpr double kStep = 1e-4;  // differences: h^2 = 1e-8 and eps/h^2 = 2e-8
  for (const Joint& joint : joints) {
    std::vector<ConstraintRow> here, before, after;
    std::vector<BodyState> past = now, next = now;
    for (BodyState& body : past) move(-kStep, &body);
    for (BodyState& body : next) move(kStep, &body);
    add_rows(joint, now, &here);
    add_rows(joint, past, &before);
    add_rows(joint, next, &after);
    for (std::size_t r = 0; r < here.size(); ++r) {
      Twist6 va, vb;
      va << now[0].velocity, now[0].angular_velocity;
      vb << now[1].velocity, now[1].angular_velocity;
      const double rate = here[r].ja.dot(va) + here[r].jb.dot(vb);
      const double second =
          (after[r].value - 2.0 * here[r].value + before[r].value) / (kStep * kStep);
      const double first = (after[r].value - before[r].value) / (2.0 * kStep);
      CHECK(std::abs(rate - first) < 1e-7);
      CHECK(std::abs(-here[r].gamma - second) < 1e-6);
    }
  }
}

TEST_CASE("A compound pendulum falls as in the textbook", "[unit][reference]") {
  const double mass = 3.0, length = 0.7, inertia = 0.2, angle = 0.6, rate = 1.3, gravity = 9.81;
  const std::vector<RigidBody> bodies = {
      {1e3, Matrix3d::Identity(), Vector3d::Zero()},
      {mass, Vector3d(inertia, 0.3, 0.05).asDiagonal(), Vector3d::Zero()}};
  std::vector<BodyState> state(2);
  state[1].orientation = Eigen::AngleAxisd(angle, Vector3d::UnitX());
  state[1].angular_velocity = rate * Vector3d::UnitX();
  const Vector3d pivot(0.0, 0.0, length);
  state[1].position = -state[1].rotate(pivot);
  state[1].velocity = state[1].angular_velocity.cross(state[1].position);
  std::vector<ConstraintRow> rows;
  add_rows(make_coincident(0, 1, Vector3d::Zero(), pivot), state, &rows);
  std::vector<Wrench> wrenches(2);
  wrenches[1].force.z() = -mass * gravity;
  for (int i = 0; i < 6; ++i) {  // hold body 0 in place
    ConstraintRow hold;
    hold.a = hold.b = 0;
    hold.ja[i] = 1.0;
    rows.push_back(hold);
  }
  const std::vector<Twist6> a = solve_accelerations(bodies, state, rows, wrenches);
  const double expected =
      -mass * gravity * length * std::sin(angle) / (inertia + mass * length * length);
  // Rounding of a system of condition number < 1e4.
  CHECK(a[1][3] == Approx(expected).epsilon(1e-12));
  CHECK(a[1].tail<2>().norm() == Approx(0.0).margin(1e-12));
  const double centripetal = rate * rate * length;
  const double lift = centripetal * std::cos(angle) + expected * length * std::sin(angle);
  CHECK(std::abs(a[1][2] - lift) < 1e-12);  // m/s^2: as above
}

TEST_CASE("The joints leave fourteen degrees of freedom and twelve idle rods",
          "[unit][reference]") {
  for (const bool massive : {true, false}) {
    VehicleSpec spec = make_paper_sedan_spec();
    if (!massive) spec.suspension[0].strut_rod.mass = 0.0;
    const FullCoordinateCar car = make_car(spec);
    const ReferenceState state = car.assemble(make_random_state(car, 2));
    const std::size_t bodies = car.layout().bodies.size();
    const auto rows = car.calc_constraints(state);
    CHECK(bodies == (massive ? 25 : 23));
    CHECK(rows.size() == 6 * bodies - 26);
    // Independent: the smallest singular value is far from rounding.
    const VectorXd singular = make_jacobian(rows, bodies).jacobiSvd().singularValues();
    CHECK(singular.minCoeff() > 1e-3);
  }
}

TEST_CASE("The assembled whole car has the mass, centroid and inertia it was given",
          "[unit][reference]") {
  const VehicleSpec spec = make_paper_sedan_spec();
  const FullCoordinateCar car = make_car(spec);
  double mass = 0.0;
  Vector3d moment = Vector3d::Zero();
  Matrix3d inertia = Matrix3d::Zero();
  for (std::size_t k = 0; k < car.layout().bodies.size(); ++k) {
    const RigidBody& body = car.layout().bodies[k];
    const Vector3d& r = car.layout().centers[k];
    const Vector3d& e = body.rod_axis;
    mass += body.mass;
    moment += body.mass * r;
    inertia += body.inertia - body.inertia * e * e.transpose() +
               body.mass * (r.squaredNorm() * Matrix3d::Identity() - r * r.transpose());
  }
  const Sym3<double>& j = spec.whole.inertia;
  Matrix3d expected;
  expected << j.xx, j.xy, j.xz, j.xy, j.yy, j.yz, j.xz, j.yz, j.zz;
  CHECK(mass == Approx(1155.0).epsilon(1e-14));
  CHECK(moment.norm() == Approx(0.0).margin(1e-11));                // 1e3 kg m of rounding
  CHECK((inertia - expected).norm() == Approx(0.0).margin(1e-10));  // 3e3 kg m^2 of rounding
}

TEST_CASE("Assembled states satisfy the joints and reproduce the coordinates",
          "[unit][reference]") {
  VehicleSpec spec = make_paper_sedan_spec();
  spec.rack_position = 0.008;
  const FullCoordinateCar car = make_car(spec);
  for (std::uint64_t seed = 10; seed < 20; ++seed) {
    const ReferenceState state = car.assemble(make_random_state(car, seed));
    for (const ConstraintRow& row : car.calc_constraints(state)) {
      Twist6 va, vb;
      const BodyState& a = state.bodies[static_cast<std::size_t>(row.a)];
      const BodyState& b = state.bodies[static_cast<std::size_t>(row.b)];
      va << a.velocity, a.angular_velocity;
      vb << b.velocity, b.angular_velocity;
      CHECK(std::fabs(row.value) < 1e-14);                        // m: some eps of 2 m
      CHECK(std::fabs(row.ja.dot(va) + row.jb.dot(vb)) < 1e-12);  // m/s: some eps of 20 m/s
    }
    for (std::size_t i = 0; i < 4; ++i) {
      std::vector<ConstraintRow> q;
      add_rows(car.layout().corners[i].coordinate, state.bodies, &q);
      CHECK(std::abs(q[0].value - state.reduced.q[i]) < 1e-14);  // m: some eps of 2 m
    }
  }
}

TEST_CASE("At nominal trim the car stands still on the axle loads of statics",
          "[unit][reference]") {
  for (const bool massive : {true, false}) {
    VehicleSpec spec = make_paper_sedan_spec();
    if (!massive) spec.suspension[0].strut_rod.mass = 0.0;
    // Toe with camber moves the contact some micrometers off the axle, which statics leave out.
    for (SuspensionSpec& axle : spec.suspension) axle.static_toe = 0.0;
    FullCoordinateCar car = make_car(spec);
    car.set_frictionless(true);
    const ReferenceState state = car.assemble(car.make_nominal());
    const ReducedAcceleration a = car.calc_accelerations(state);
    constexpr double kStill = 1e-9;  // m/s^2, rad/s^2: 1e4 N of balanced forces, epsilon, 20 kg
    CHECK(a.linear.norm() < kStill);
    CHECK(a.angular.norm() < kStill);
    for (std::size_t i = 0; i < 4; ++i) {
      CHECK(std::fabs(a.q_ddot[i]) < kStill);
      CHECK(std::fabs(a.spin_dot[i]) < kStill);
      // 1155 kg * 9.81 m/s^2 on axles at 0.7209 m and 2.0791 m.
      const double axle = 1155.0 * 9.81 * (i < 2 ? 2.0791 : 0.7209) / 2.8;
      CHECK(car.calc_contact(state, static_cast<int>(i)).load == Approx(axle / 2).epsilon(1e-11));
    }
  }
}

TEST_CASE("Momentum changes by the outer forces alone", "[property][reference]") {
  const FullCoordinateCar car = make_car(make_paper_sedan_spec(), 500.0);
  for (std::uint64_t seed = 100; seed < 120; ++seed) {
    const ReferenceState state = car.assemble(make_random_state(car, seed));
    const Momentum rate = calc_momentum_rate(car, state), outer = calc_outer_forces(car, state);
    CHECK((rate.force - outer.force).norm() < kRounding * outer.force.norm());
    CHECK((rate.moment - outer.moment).norm() < kRounding * (1e4 + outer.moment.norm()));
  }
}

TEST_CASE("Joints do no work", "[property][reference]") {
  const FullCoordinateCar car = make_car(make_paper_sedan_spec(), 500.0);
  for (std::uint64_t seed = 200; seed < 220; ++seed) {
    const ReferenceState state = car.assemble(make_random_state(car, seed));
    const double power = car.calc_power(state);
    CHECK(std::abs(calc_energy_rate(car, state) - power) < kRounding * 1e5);  // W
  }
}

TEST_CASE("Without springs and road the car falls freely", "[unit][reference]") {
  FullCoordinateCar car = make_car(make_paper_sedan_spec());
  for (int corner = 0; corner < kCorners; ++corner) car.set_strut(corner, {0.0, 0.0});
  ReducedState s = car.make_nominal();
  s.position.z() = 5.0;
  s.quaternion = Eigen::Vector4d(0.7, 0.3, -0.5, 0.2).normalized();
  s.q = {0.02, -0.03, 0.04, -0.01};
  const ReferenceState state = car.assemble(s);
  const ReducedAcceleration a = car.calc_accelerations(state);
  const Vector3d down = state.bodies[0].orientation * a.linear;
  CHECK((down - Vector3d(0.0, 0.0, -9.81)).norm() < 1e-10);
  CHECK(a.angular.norm() < 1e-10);
  for (std::size_t i = 0; i < 4; ++i) CHECK(std::fabs(a.q_ddot[i]) < 1e-10);
}

TEST_CASE("The mirrored car moves as the mirror image", "[property][reference]") {
  const FullCoordinateCar car = make_car(make_paper_sedan_spec(), 500.0);
  const ReducedState s = make_random_state(car, 300);
  ReducedState m = s;
  m.position.y() *= -1.0;
  m.velocity.y() *= -1.0;
  m.quaternion[1] *= -1.0;
  m.quaternion[3] *= -1.0;
  m.angular_velocity =
      Vector3d(-s.angular_velocity.x(), s.angular_velocity.y(), -s.angular_velocity.z());
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t other = i ^ 1;
    m.q[i] = s.q[other];
    m.q_dot[i] = s.q_dot[other];
    m.spin[i] = s.spin[other];
  }
  const ReducedAcceleration a = car.calc_accelerations(car.assemble(s));
  const ReducedAcceleration b = car.calc_accelerations(car.assemble(m));
  const double scale = a.linear.norm() + a.angular.norm();
  CHECK((b.linear - a.linear.cwiseProduct(Vector3d(1, -1, 1))).norm() < kRounding * scale);
  CHECK((b.angular - a.angular.cwiseProduct(Vector3d(-1, 1, -1))).norm() < kRounding * scale);
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(b.q_ddot[i] == Approx(a.q_ddot[i ^ 1]).epsilon(kRounding));
    CHECK(b.spin_dot[i] == Approx(a.spin_dot[i ^ 1]).epsilon(kRounding).margin(kRounding));
  }
}

TEST_CASE("The front corner follows an independent MacPherson curve", "[reference]") {
  // Generic MacPherson strut of Chrono's public data, wheel travel -100 and +100 mm, by another
  // program to 1e-10: camber, toe, wheel center x and y, spring length.
  struct Row {
    double travel, camber, toe, dx, dy, spring;
  };
  const Row rows[] = {
      {-0.1, 0.03582101844, 0.05089187813, 0.009049686299, -0.01104159425, 0.4290853037},
      {0.1, -0.01076900432, -0.06884542132, -0.01277320295, -0.008947891267, 0.2433718335}};
  VehicleSpec spec = make_paper_sedan_spec();
  SuspensionSpec& front = spec.suspension[0];
  const Vec3<double> center{-0.04000403, 0.0, -0.02602507};
  front.wheel_center_y = 1.09999965;
  front.arm_front = Vec3<double>{0.220, 0.520, -0.156} - center;
  front.arm_rear = Vec3<double>{-0.300, 0.507, -0.137} - center;
  front.ball_joint = Vec3<double>{-0.02165371, 0.94057703, -0.17402826} - center;
  front.strut_top = Vec3<double>{-0.115, 0.785, 0.579} - center;
  front.strut_bottom = Vec3<double>{-0.07402507, 0.8532915, 0.2484536} - center;
  front.rods[0].chassis = Vec3<double>{-0.300, 0.520, -0.059} - center;
  front.rods[0].upright = Vec3<double>{-0.2373756, 0.89495045, -0.01605418} - center;
  front.spring_upper.position = front.damper_upper.position = front.strut_top;
  front.spring_lower.position = front.damper_lower.position = front.strut_bottom;
  front.static_toe = front.static_camber = 0.0;
  const FullCoordinateCar car = make_car(spec);
  ReducedState s = car.make_nominal();
  const Vector3d rest = car.get_wheel_center(car.assemble(s), kFrontLeft);
  for (const Row& row : rows) {
    for (int i = 0; i < 20; ++i) {  // the travel is nearly linear in q
      const Vector3d now = car.get_wheel_center(car.assemble(s), kFrontLeft);
      s.q[0] += row.travel - (now - rest).z();
    }
    const ReferenceState state = car.assemble(s);
    const Vector3d moved = car.get_wheel_center(state, kFrontLeft) - rest;
    const Vector3d u = car.get_spin_axis(state, kFrontLeft);
    constexpr double kPrinted = 1e-9;  // half a digit of the ten that are printed
    CHECK(std::abs(moved.z() - row.travel) < 1e-12);
    CHECK(std::abs(moved.x() - row.dx) < kPrinted);
    CHECK(std::abs(moved.y() - row.dy) < kPrinted);
    CHECK(std::abs(-std::asin(u.z()) - row.camber) < kPrinted);
    CHECK(std::abs(std::atan2(u.x(), u.y()) - row.toe) < kPrinted);
    CHECK(std::abs(car.calc_spring(state, kFrontLeft).length - row.spring) < kPrinted);
  }
}

TEST_CASE("Drive torque turns the wheels forward and lifts the nose by its reaction",
          "[unit][reference]") {
  FullCoordinateCar car = make_car(make_paper_sedan_spec());
  car.set_frictionless(true);
  const ReferenceState state = car.assemble(car.make_nominal());
  car.set_drive_torque(500.0);
  const ReducedAcceleration a = car.calc_accelerations(state);
  CHECK(a.spin_dot[0] > 0.9 * 250.0 / 1.4);
  CHECK(a.spin_dot[1] == Approx(a.spin_dot[0]).epsilon(kRounding));
  CHECK(a.angular.y() < 0.0);
}

TEST_CASE("A flight without damping keeps energy and momentum", "[reference][slow]") {
  VehicleSpec spec = make_paper_sedan_spec();
  for (SuspensionSpec& axle : spec.suspension) {
    for (StrutSpec& strut : axle.strut) strut.damping = 0.0;
  }
  const FullCoordinateCar car = make_car(spec);
  ReducedState s = make_random_state(car, 400);
  s.position.z() = 3.0;
  const ReferenceState first = car.assemble(s);
  TrajectoryStatistics statistics;
  const ReferenceState last = car.assemble(integrate(car, s, {0.2}, {}, &statistics).back());
  const double before = car.calc_energy(first).total(), after = car.calc_energy(last).total();
  INFO("evaluations " << statistics.evaluations);
  // 1e-11 of tolerance over some hundred steps on 3e5 J.
  CHECK(after == Approx(before).epsilon(1e-9));
  Vector3d momentum = Vector3d::Zero();
  for (std::size_t k = 0; k < first.bodies.size(); ++k) {
    const double mass = car.layout().bodies[k].mass;
    momentum += mass * (last.bodies[k].velocity - first.bodies[k].velocity);
  }
  // The starting momentum is 2e4 kg m/s.
  CHECK((momentum - Vector3d(0.0, 0.0, -0.2 * 9.81 * 1155.0)).norm() < 1e-6);
}

TEST_CASE("A landing is found and stays inside the tolerance", "[reference][slow]") {
  FullCoordinateCar car = make_car(make_paper_sedan_spec());
  ReducedState s = car.make_nominal();
  s.position.z() += 0.05;
  s.velocity.x() = 20.0;
  s.spin.fill(20.0 / 0.46);
  TrajectoryStatistics fine, coarse;
  const ReducedState a = integrate(car, s, {0.12}, {1e-11}, &fine).back();
  const ReducedState b = integrate(car, s, {0.12}, {1e-9}, &coarse).back();
  CHECK(fine.events >= 2);  // the two wheels of an axle land together
  CHECK((a.position - b.position).norm() < 1e-7);
  CHECK((a.velocity - b.velocity).norm() < 1e-5);
}

TEST_CASE("Spin axes point left, toe turns the front in and camber the top out",
          "[unit][reference]") {
  VehicleSpec spec = make_paper_sedan_spec();
  spec.suspension[0].static_toe = 0.02;
  spec.suspension[0].static_camber = 0.03;
  const FullCoordinateCar car = make_car(spec);
  const ReferenceState state = car.assemble(car.make_nominal());
  for (const int corner : {kFrontLeft, kFrontRight}) {
    const double outwards = corner == kFrontLeft ? 1.0 : -1.0;
    const Vector3d u = car.get_spin_axis(state, corner);
    const Vector3d forward = u.cross(Vector3d::UnitZ()).normalized();
    const Vector3d top = forward.cross(u);
    CHECK(u.y() > 0.99);
    CHECK(std::asin(forward.y()) == Approx(-0.02 * outwards).epsilon(1e-12));
    CHECK(std::asin(top.y() * outwards) == Approx(0.03).epsilon(1e-3));  // cos(toe) aside
  }
}

TEST_CASE("A tire slips and pushes as its contact moves", "[unit][reference]") {
  VehicleSpec spec = make_paper_sedan_spec();
  for (SuspensionSpec& axle : spec.suspension) axle.static_toe = axle.static_camber = 0.0;
  const FullCoordinateCar car = make_car(spec);
  ReducedState s = car.make_nominal();
  s.velocity = Vector3d(20.0, 1.0, 0.0);
  const double load = 0.5 * 1155.0 * 9.81 * 2.0791 / 2.8, rho = load / 200000.0;
  s.spin.fill(1.01 * 20.0 / (0.4673 - rho / 3.0));  // the rolling radius without coefficients
  const WheelContact c = car.calc_contact(car.assemble(s), kFrontLeft);
  constexpr double kEpsilon = 1e-10;  // rounding of positions of 1 m against 20 mm
  CHECK(c.deflection == Approx(rho).epsilon(kEpsilon));
  CHECK(c.slip.kappa == Approx(0.01).epsilon(kEpsilon));
  CHECK(c.slip.alpha == Approx(std::atan(0.05)).epsilon(kEpsilon));
  CHECK(c.force.x() > 0.0);
  CHECK(c.force.y() < 0.0);
  s.q_dot[0] = 0.1;  // compression of the strut lifts the wheel
  s.velocity.z() = -0.5;
  const WheelContact sinking = car.calc_contact(car.assemble(s), kFrontLeft);
  CHECK(sinking.deflection_rate > 0.3);
  CHECK(sinking.load == Approx(load + 500.0 * sinking.deflection_rate).epsilon(kEpsilon));
}

TEST_CASE("A damper of the reference car dissipates", "[unit][reference]") {
  const FullCoordinateCar car = make_car(make_paper_sedan_spec());
  const ReferenceState state = car.assemble(make_random_state(car, 500));
  for (int corner = 0; corner < kCorners; ++corner) {
    const LineElement damper = car.calc_damper(state, corner);
    CHECK(damper.force * damper.rate ==
          Approx(-1980.0 * damper.rate * damper.rate).epsilon(1e-15));  // a few roundings
    CHECK(damper.rate != 0.0);
  }
}

}  // namespace strut::reference
