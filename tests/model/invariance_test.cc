// Laws the equations of motion obey in any state: symmetry, momentum, energy, work.

#include <Eigen/Dense>
#include <algorithm>
#include <catch2/catch.hpp>

#include "model/car/dynamics.h"
#include "tests/model/test_corner.h"

namespace strut {
namespace {

using test::append;
using test::differentiate;
using test::make_random_state;
using test::prepare;
using test::Random;
using test::tolerance;
using I = StateIndex;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A prepared car with its workspace: state in, derivative out.
struct Car {
  PreparedCase prepared;
  Workspace<double> ws{};

  explicit Car(const VehicleSpec& spec, BumpShape shape = BumpShape::kNone)
      : prepared(prepare({spec, make_maneuver(shape)})) {}

  static ManeuverSpec make_maneuver(BumpShape shape) {
    ManeuverSpec maneuver;
    maneuver.road.shape = shape;
    return maneuver;
  }
  Vehicle<double>& vehicle() { return prepared.vehicle; }
  State<double> evaluate(const State<double>& x) {
    State<double> dx{};
    const NewtonClosure<double> closure{&prepared.vehicle.layout, &prepared.vehicle.numbers};
    calc_derivative(prepared.vehicle, closure, TireMode::kRolling, x.data(), dx.data(), ws);
    return dx;
  }
  double calc_energy_at(const State<double>& x) {
    evaluate(x);
    return calc_energy(prepared.vehicle, x.data(), ws);
  }
  State<double> make_state(Random& random) const {
    return make_random_state(random, prepared.mechanism->car.center_height, 20.0,
                             prepared.vehicle.numbers.tire[kFront].radius);
  }
};

Car make_paper_car_on(BumpShape shape) { return Car(reference::make_paper_sedan_spec(), shape); }

/// Springs and dampers that differ at every corner.
VehicleSpec make_uneven_spec() {
  VehicleSpec spec = reference::make_paper_sedan_spec();
  double share = 0.8;
  for (SuspensionSpec& axle : spec.suspension) {
    for (StrutSpec& strut : axle.strut) {
      strut.stiffness *= share;
      strut.damping *= 2.0 - share;
      share += 0.13;
    }
  }
  return spec;
}

/// The velocities, whose rates are accelerations.
constexpr int kVelocities = 14;

VectorXd get_velocities(const State<double>& x) {
  return Eigen::Map<const VectorXd>(x.data() + I::kVelocity, kVelocities);
}

/// Largest difference over the largest size, group by group: linear, angular, corners, spins.
double compare(const VectorXd& a, const VectorXd& b) {
  constexpr int kGroups[][2] = {{0, 3}, {3, 3}, {6, 4}, {10, 4}};
  double worst = 0.0;
  for (const auto& [begin, count] : kGroups) {
    const double scale = 1.0 + b.segment(begin, count).cwiseAbs().maxCoeff();
    worst = std::max(
        worst, (a.segment(begin, count) - b.segment(begin, count)).cwiseAbs().maxCoeff() / scale);
  }
  return worst;
}

TEST_CASE("On a flat road accelerations depend on neither place nor heading", "[unit][property]") {
  Car car(make_uneven_spec());
  Random random(11);
  for (int i = 0; i < 20; ++i) {
    const State<double> x = car.make_state(random);
    const double yaw = random.uniform(-3.0, 3.0), c = std::cos(0.5 * yaw), s = std::sin(0.5 * yaw);
    State<double> turned = x;
    turned[I::kPosition] += random.uniform(-100.0, 100.0);
    turned[I::kPosition + 1] += random.uniform(-100.0, 100.0);
    const double* e = x.data() + I::kQuaternion;
    double* q = turned.data() + I::kQuaternion;
    q[0] = c * e[0] - s * e[3];
    q[1] = c * e[1] - s * e[2];
    q[2] = c * e[2] + s * e[1];
    q[3] = c * e[3] + s * e[0];
    const State<double> dx = car.evaluate(x), dturned = car.evaluate(turned);
    // Forces of 1e4 N on 1 kg m^2 round at 1e-12.
    CHECK(compare(get_velocities(dturned), get_velocities(dx)) < tolerance(1e-11));
    const double *v = dx.data(), *w = dturned.data();
    CHECK(std::abs(w[0] - (std::cos(yaw) * v[0] - std::sin(yaw) * v[1])) < tolerance(1e-12));
    CHECK(std::abs(w[1] - (std::sin(yaw) * v[0] + std::cos(yaw) * v[1])) < tolerance(1e-12));
    CHECK(std::abs(dturned[I::kWork] - dx[I::kWork]) < tolerance(1e-11) * 1e5);
  }
}

/// Signs of the first 7 + 6 components under reflection in the plane y = 0, and swapped corners.
State<double> mirror_state(const State<double>& x) {
  State<double> m = x;
  for (const int i : {I::kPosition + 1, I::kQuaternion + 1, I::kQuaternion + 3, I::kVelocity + 1,
                      I::kAngularVelocity, I::kAngularVelocity + 2}) {
    m[i] = -x[i];
  }
  for (const int group : {I::kCorner, I::kWheelAngle, I::kCornerRate, I::kSpin}) {
    for (const int left : {kFrontLeft, kRearLeft}) {
      m[group + left] = x[group + left + 1];
      m[group + left + 1] = x[group + left];
    }
  }
  return m;
}

TEST_CASE("The mirrored car in the mirrored state has mirrored accelerations", "[unit][property]") {
  VehicleSpec spec = make_uneven_spec(), mirrored = spec;
  for (SuspensionSpec& axle : mirrored.suspension) std::swap(axle.strut[0], axle.strut[1]);
  Car car(spec), twin(mirrored);
  Random random(12);
  for (int i = 0; i < 20; ++i) {
    const State<double> x = car.make_state(random);
    const State<double> expected = mirror_state(car.evaluate(x));
    const State<double> dx = twin.evaluate(mirror_state(x));
    CHECK(compare(get_velocities(dx), get_velocities(expected)) < tolerance(1e-11));
    for (int k = 0; k < I::kVelocity; ++k) {
      CHECK(std::abs(dx[k] - expected[k]) < tolerance(1e-11));
    }
    CHECK(std::abs(dx[I::kWork] - expected[I::kWork]) < tolerance(1e-11) * 1e5);
  }
}

/// Mass matrix of the fourteen velocities by polarizing the kinetic energy at the place of x.
MatrixXd calc_mass_matrix(Car& car, State<double> x) {
  const auto energy = [&](int i, int j) {
    std::fill_n(x.begin() + I::kVelocity, kVelocities, 0.0);
    if (i >= 0) x[I::kVelocity + i] += 1.0;
    if (j >= 0) x[I::kVelocity + j] += 1.0;
    return car.calc_energy_at(x);
  };
  const double rest = energy(-1, -1);
  MatrixXd m(kVelocities, kVelocities);
  for (int i = 0; i < kVelocities; ++i) {
    for (int j = 0; j < kVelocities; ++j) {
      m(i, j) = energy(i, j) - energy(i, -1) - energy(j, -1) + rest;
    }
  }
  return m;
}

TEST_CASE("Kinetic energy is a positive definite quadratic form of the velocities",
          "[unit][property]") {
  Car car = make_paper_car_on(BumpShape::kNone);
  Random random(13);
  for (int i = 0; i < 5; ++i) {
    const State<double> x = car.make_state(random);
    const MatrixXd m = calc_mass_matrix(car, x);
    CHECK((m - m.transpose()).cwiseAbs().maxCoeff() < tolerance(1e-10));
    CHECK(m.llt().info() == Eigen::Success);
    State<double> rest = x;
    std::fill_n(rest.begin() + I::kVelocity, kVelocities, 0.0);
    const VectorXd v = get_velocities(x);
    const double kinetic = car.calc_energy_at(x) - car.calc_energy_at(rest);
    // Polarization rounds at 1e-12 of the 6 kJ of potential energy, times speeds squared.
    CHECK(std::abs(kinetic - 0.5 * v.dot(m * v)) < tolerance(1e-12) * kinetic * 100.0);
  }
}

/// Work of gravity per unit of each velocity, from the potential energy along its motion.
VectorXd calc_gravity_forces(Car& car, State<double> x, double gravity) {
  std::fill_n(x.begin() + I::kVelocity, kVelocities, 0.0);
  VectorXd force(kVelocities);
  for (int i = 0; i < kVelocities; ++i) {
    State<double> moving = x;
    moving[I::kVelocity + i] = 1.0;
    const State<double> rate = car.evaluate(moving);
    const auto potential = [&](double s) {
      State<double> there = x;
      for (int k = 0; k < I::kVelocity; ++k) there[k] += s * rate[k];
      car.vehicle().numbers.gravity = gravity;
      const double with = car.calc_energy_at(there);
      car.vehicle().numbers.gravity = 0.0;
      return std::vector<double>{with - car.calc_energy_at(there)};
    };
    force[i] = -differentiate(potential, 0.0, 1e-3)[0];
  }
  return force;
}

TEST_CASE("Gravity accelerates by the mass matrix of the kinetic energy", "[unit][property]") {
  Car car = make_paper_car_on(BumpShape::kNone);
  const double gravity = car.vehicle().numbers.gravity;
  Random random(14);
  for (int i = 0; i < 5; ++i) {
    const State<double> x = car.make_state(random);
    car.vehicle().numbers.gravity = gravity;
    const VectorXd with = get_velocities(car.evaluate(x));
    car.vehicle().numbers.gravity = 0.0;
    const VectorXd without = get_velocities(car.evaluate(x));
    const VectorXd force = calc_gravity_forces(car, x, gravity);
    const VectorXd expected = calc_mass_matrix(car, x).ldlt().solve(force);
    // Differences of an energy of 6 kJ over 1 mm are good to 1e-9 N.
    CHECK(compare(with - without, expected) < tolerance(1e-8));
  }
}

TEST_CASE("Drive torque turns the wheel against the chassis or the ground, not the upright",
          "[unit][property]") {
  const double fraction = GENERATE(1.0, 0.3, 0.0);  // that the chassis reacts
  Car car = make_paper_car_on(BumpShape::kNone);
  Random random(15);
  constexpr double kTorque = 700.0;
  for (int corner = 0; corner < kCorners; ++corner) {
    const State<double> x = car.make_state(random);
    car.vehicle().numbers.drive_torque.fill(0.0);
    const State<double> without = car.evaluate(x);
    car.vehicle().numbers.drive_torque[corner] = kTorque;
    car.vehicle().numbers.drive_reaction = fraction;
    const State<double> with = car.evaluate(x);
    const Vec3<double> u = car.ws.motion[corner].axis;
    const Vec3<double> w = get_vec3(x.data(), I::kAngularVelocity);
    VectorXd force = VectorXd::Zero(kVelocities);
    const double reaction = fraction * kTorque;
    force.segment<3>(3) << -reaction * u.x, -reaction * u.y, -reaction * u.z;
    force[10 + corner] = kTorque;
    const VectorXd expected = calc_mass_matrix(car, x).ldlt().solve(force);
    CHECK(compare(get_velocities(with) - get_velocities(without), expected) < tolerance(1e-9));
    CHECK(with[I::kWork] - without[I::kWork] ==
          Approx(kTorque * x[I::kSpin + corner] - reaction * dot(u, w)).epsilon(tolerance(1e-9)));
  }
}

TEST_CASE("Energy changes by the work of tires, dampers and drive alone", "[unit][property]") {
  // Constraint and gyroscopic forces do no work: whatever is left out or doubled shows here.
  for (const BumpShape shape : {BumpShape::kNone, BumpShape::kCosine}) {
    Car car(make_uneven_spec(), shape);
    Random random(16);
    double worst = 0.0;
    for (int i = 0; i < 50; ++i) {
      const State<double> x = car.make_state(random);
      const State<double> dx = car.evaluate(x);
      const auto energy = [&](double t) {
        State<double> there = x;
        for (int k = 0; k < I::kWork; ++k) there[k] += t * dx[k];
        return std::vector<double>{car.calc_energy_at(there)};
      };
      const double rate = differentiate(energy, 0.0, 1e-4)[0];
      worst = std::max(worst, std::abs(rate - dx[I::kWork]) / std::abs(dx[I::kWork]));
    }
    INFO("worst relative difference " << worst);
    // 1e-16 of 250 kJ over 0.1 ms against some 10 kW.
    CHECK(worst < tolerance(1e-8));
  }
}

/// Linear and angular momentum in world axes, about the world origin.
std::vector<double> calc_momentum(const Car& car, const State<double>& x) {
  const Workspace<double>& ws = car.ws;
  const Vec3<double> v = get_vec3(x.data(), I::kVelocity);
  const Vec3<double> w = get_vec3(x.data(), I::kAngularVelocity);
  const Vec3<double> linear =
      ws.rotation * (car.prepared.vehicle.numbers.mass * v + cross(w, ws.moment) + ws.moment_rate);
  Vec3<double> l = cross(ws.moment, v) + ws.inertia * w;
  for (int c = 0; c < kCorners; ++c) {
    l += x[I::kCornerRate + c] * ws.motion[c].coupling +
         (car.prepared.vehicle.numbers.inertia[c].spin_inertia * x[I::kSpin + c]) *
             ws.motion[c].axis;
  }
  std::vector<double> all;
  append(all, linear);
  append(all, cross(get_vec3(x.data(), I::kPosition), linear) + ws.rotation * l);
  return all;
}

TEST_CASE("Momentum changes by gravity and the road's forces alone", "[unit][property]") {
  // Springs, dampers and drive torque are inner forces: they never push the car as a whole.
  Car car(make_uneven_spec());
  Random random(17);
  for (int i = 0; i < 20; ++i) {
    const State<double> x = car.make_state(random);
    const State<double> dx = car.evaluate(x);
    const Workspace<double>& ws = car.ws;
    const Vec3<double> origin = get_vec3(x.data(), I::kPosition);
    const Vec3<double> weight{0.0, 0.0,
                              -car.vehicle().numbers.mass * car.vehicle().numbers.gravity};
    const Vec3<double> centroid =
        origin + (1.0 / car.vehicle().numbers.mass) * (ws.rotation * ws.moment);
    Vec3<double> force = weight, moment = cross(centroid, weight);
    for (int c = 0; c < kCorners; ++c) {
      const Vec3<double> f = ws.rotation * ws.wrench[c].force;
      const Vec3<double> at = origin + ws.rotation * (ws.motion[c].center + ws.contact[c].arm);
      force += f;
      moment += cross(at, f) + ws.rotation * ws.wrench[c].moment;
    }
    const auto momentum = [&](double t) {
      State<double> there = x;
      for (int k = 0; k < I::kWork; ++k) there[k] += t * dx[k];
      car.evaluate(there);
      return calc_momentum(car, there);
    };
    const std::vector<double> rate = differentiate(momentum, 0.0, 1e-4);
    const double truth[] = {force.x, force.y, force.z, moment.x, moment.y, moment.z};
    for (std::size_t k = 0; k < 6; ++k) {
      // 1e-16 of 3e4 N s (3e5 N m s) over 0.1 ms.
      CHECK(std::abs(rate[k] - truth[k]) < tolerance(1e-5));
    }
  }
}

TEST_CASE("A corner beyond its travel is told by how much", "[unit]") {
  Car car = make_paper_car_on(BumpShape::kNone);
  State<double> x = car.prepared.start;
  car.evaluate(x);
  CHECK(car.ws.travel_excess < 0.0);
  x[I::kCorner + kRearRight] = -1.1 * kHalfTravel;
  car.evaluate(x);
  CHECK(car.ws.travel_excess == Approx(0.1 * kHalfTravel));
}

TEST_CASE("A damper dissipates", "[unit][property]") {
  Car car(make_uneven_spec());
  Random random(18);
  for (int i = 0; i < 50; ++i) {
    const State<double> x = car.make_state(random);
    car.evaluate(x);
    for (int c = 0; c < kCorners; ++c) {
      const double rate = x[I::kCornerRate + c] * car.ws.motion[c].length_q[kDamperLine];
      CHECK(car.ws.strut[c].power < 0.0);
      CHECK(
          car.ws.strut[c].power ==
          Approx(-car.vehicle().numbers.damper[c].damping * rate * rate).epsilon(tolerance(1e-12)));
    }
  }
}

}  // namespace
}  // namespace strut
