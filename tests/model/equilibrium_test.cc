// The car at rest and rolling steadily: static loads, sag, ride rates, body modes, refusals.

#include <Eigen/Dense>
#include <algorithm>
#include <catch2/catch.hpp>
#include <vector>

#include "model/car/dynamics.h"
#include "tests/model/test_corner.h"
#include "tests/reference/full_coordinate_car.h"

namespace strut {
namespace {

using test::calc_motion;
using test::prepare;
using test::tolerance;
using I = StateIndex;

Case make_flat_case(const VehicleSpec& spec = reference::make_paper_sedan_spec()) {
  ManeuverSpec maneuver;
  maneuver.road.shape = BumpShape::kNone;
  return {spec, maneuver};
}

using test::rest;

double get_pitch(const State<double>& x) { return 2.0 * x[I::kQuaternion + 2]; }

/// Static load of one tire: lever rule.
double calc_load(const WholeCarSpec& whole, double gravity, int corner) {
  const double wheelbase = whole.centroid_to_front + whole.centroid_to_rear;
  const double lever = axle_of(corner) == kFront ? whole.centroid_to_rear : whole.centroid_to_front;
  return 0.5 * whole.mass * gravity * lever / wheelbase;
}

TEST_CASE("Static tire loads are those of the lever rule", "[unit]") {
  VehicleSpec straight = reference::make_paper_sedan_spec();
  for (SuspensionSpec& axle : straight.suspension) axle.static_toe = axle.static_camber = 0.0;
  for (const VehicleSpec& spec : {straight, reference::make_paper_sedan_spec()}) {
    const Case c = make_flat_case(spec);
    const auto load = rest(prepare(c)).load;
    for (int corner = 0; corner < kCorners; ++corner) {
      // Camber times toe times radius moves the contact points by up to 10 of 2.8e6 micrometers.
      const double allowed = spec.suspension[kRear].static_toe == 0.0 ? 1e-7 : 1e-5;
      CHECK(load[corner] ==
            Approx(calc_load(spec.whole, c.maneuver.gravity, corner)).epsilon(tolerance(allowed)));
    }
  }
}

TEST_CASE("A car on its nominal springs stands level at nominal trim", "[unit]") {
  const PreparedCase c = prepare(make_flat_case());
  const TrimResult trim = rest(c);
  constexpr double kContactOffset = 1e-5;  // m, rad: see above
  for (int corner = 0; corner < kCorners; ++corner) {
    CHECK(std::abs(trim.state[I::kCorner + corner]) < tolerance(kContactOffset));
  }
  CHECK(std::abs(get_pitch(trim.state)) < tolerance(kContactOffset));
  CHECK(std::abs(trim.state[I::kQuaternion + 1]) < tolerance(kContactOffset));
  CHECK(std::abs(trim.state[I::kPosition + 2] - 0.5373) < tolerance(kContactOffset));
}

VehicleSpec make_worn_spec() {
  VehicleSpec spec = reference::make_paper_sedan_spec();
  const double worn[] = {35500.0, 30500.0}, fresh[] = {40000.0, 35000.0};
  for (int axle = 0; axle < kAxles; ++axle) {
    for (StrutSpec& strut : spec.suspension[axle].strut) {
      strut.stiffness = worn[axle];
      strut.nominal_stiffness = fresh[axle];
    }
  }
  return spec;
}

/// Kinematics of the independent car around q: d(spring length)/d(wheel rise) and its derivative.
struct SpringRatio {
  double ratio = 0.0;   // 1
  double change = 0.0;  // 1/m
};

SpringRatio calc_spring_ratio(const reference::FullCoordinateCar& car, int corner, double q) {
  constexpr double kStep = 1e-3;  // m: h^2 of third derivatives below 10 / m^2
  double length[5], rise[5], ratio[5];
  for (int i = 0; i < 5; ++i) {
    reference::ReducedState x = car.make_nominal();
    x.q[static_cast<std::size_t>(corner)] = q + (i - 2) * kStep;
    const reference::ReferenceState state = car.assemble(x);
    length[i] = car.calc_spring(state, corner).length;
    rise[i] = car.get_wheel_center(state, corner).z();
  }
  for (int i = 1; i < 4; ++i) {
    ratio[i] = (length[i + 1] - length[i - 1]) / (rise[i + 1] - rise[i - 1]);
  }
  return {ratio[2], (ratio[3] - ratio[1]) / (rise[3] - rise[1])};
}

TEST_CASE("Worn springs sag by the force over the lost stiffness", "[unit]") {
  const VehicleSpec spec = make_worn_spec();
  const PreparedCase c = prepare(make_flat_case(spec));
  const TrimResult trim = rest(c);
  const reference::FullCoordinateCar truth(spec, make_flat_case().maneuver);
  for (int corner = 0; corner < kCorners; ++corner) {
    const StrutSpec& strut = spec.suspension[axle_of(corner)].strut[0];
    const double q = trim.state[I::kCorner + corner];
    const double deflection = c.vehicle.numbers.nominal_length[corner * kLines + kSpringLine] -
                              calc_motion(c.mechanism->car, corner, q).length[kSpringLine];
    // The load on the spring grows as its lever shrinks: F ratio = F0 ratio0. Links' own weight and
    // camber change keep this to some 0.3 % of F0.
    const double force0 = c.mechanism->car.preload[corner];
    const double force = force0 * calc_spring_ratio(truth, corner, 0.0).ratio /
                         calc_spring_ratio(truth, corner, q).ratio;
    const double expected = force / strut.stiffness - force0 / strut.nominal_stiffness;
    INFO("corner " << corner << ": preload " << force0 << " N, sag " << deflection
                   << " m, expected " << expected << " m");
    CHECK(deflection > 0.005);
    CHECK(std::abs(deflection - expected) < tolerance(5e-3) * force0 / strut.stiffness);
  }
}

TEST_CASE("Worn springs with trimmed preload do not sag", "[unit]") {
  VehicleSpec spec = make_worn_spec();
  spec.preload = PreloadKind::kTrimmed;
  const TrimResult trim = rest(prepare(make_flat_case(spec)));
  for (int corner = 0; corner < kCorners; ++corner) {
    CHECK(std::abs(trim.state[I::kCorner + corner]) < tolerance(1e-5));
  }
  CHECK(std::abs(get_pitch(trim.state)) < tolerance(1e-5));
}

TEST_CASE("A spring that cannot carry the car is refused", "[unit]") {
  VehicleSpec spec = make_worn_spec();
  for (StrutSpec& strut : spec.suspension[kFront].strut) strut.stiffness = 8000.0;
  CHECK_THROWS_WITH(prepare(make_flat_case(spec)),
                    Catch::Contains("front_suspension.spring.stiffness = 8000 N/m"));
}

TEST_CASE("An equilibrium beyond a corner's travel is refused", "[unit]") {
  PreparedCase c = prepare(make_flat_case(make_worn_spec()));
  const TrimResult trim = rest(c);
  double sag = 0.0;
  for (int corner = 0; corner < kCorners; ++corner) {
    sag = std::max(sag, std::abs(trim.state[I::kCorner + corner]));
  }
  const auto set_travel = [&](double half_travel) {
    for (auto& predictor : c.vehicle.layout.predictor) predictor.half_travel = half_travel;
  };
  set_travel(1.01 * sag);
  CHECK_NOTHROW(rest(c));
  set_travel(0.99 * sag);
  CHECK_THROWS_WITH(rest(c), Catch::Contains("has no equilibrium at rest within"));
}

TEST_CASE("A torque the tires cannot pass on leaves no steady rolling", "[unit]") {
  Case c = make_flat_case(reference::make_paper_sedan_spec());
  c.maneuver.drive_torque = 2e4;  // 43 kN at the radius, five times the load on the front tires
  CHECK_THROWS_WITH(prepare(c), Catch::Contains("has no equilibrium rolling"));
}

/// Vertical stiffness of one wheel against the chassis: potential energy of the spring, twice
/// differentiated, k ratio^2 - F d(ratio)/dz.
double calc_wheel_rate(const VehicleSpec& spec, const PreparedCase& c, int corner) {
  const reference::FullCoordinateCar truth(spec, make_flat_case().maneuver);
  const SpringRatio spring = calc_spring_ratio(truth, corner, 0.0);
  const double stiffness = spec.suspension[axle_of(corner)].strut[0].stiffness;
  return stiffness * spring.ratio * spring.ratio - c.mechanism->car.preload[corner] * spring.change;
}

/// Tire load of a corner with the chassis held `lift` above rest and the corner free.
double calc_held_load(const PreparedCase& c, const State<double>& at_rest, int corner,
                      double lift) {
  State<double> x = at_rest, dx{};
  x[I::kPosition + 2] += lift;
  Workspace<double> ws{};
  GeneralizedForce<double> rhs;
  const NewtonClosure<double> closure{&c.vehicle.layout, &c.vehicle.numbers};
  const auto force_at = [&](double q) {
    x[I::kCorner + corner] = q;
    calc_derivative(c.vehicle, closure, TireMode::kFrictionless, x.data(), dx.data(), ws);
    calc_forces(c.vehicle, x.data(), ws, rhs);
    return rhs.corner[corner];
  };
  double q0 = at_rest[I::kCorner + corner], q1 = q0 + 1e-4, f0 = force_at(q0);
  for (int i = 0; i < 20 && q1 != q0; ++i) {  // secant
    const double f1 = force_at(q1);
    const double next = f1 == f0 ? q1 : q1 - f1 * (q1 - q0) / (f1 - f0);
    q0 = q1, f0 = f1, q1 = next;
  }
  force_at(q1);
  return ws.contact[corner].load;
}

/// The same from the potential energy V(z, q) of the independent car: chassis height z, one corner
/// free: V_zz - V_zq^2 / V_qq.
double calc_ride_rate(const VehicleSpec& spec, const State<double>& at_rest, int corner) {
  reference::FullCoordinateCar car(spec, make_flat_case().maneuver);
  const auto c = static_cast<std::size_t>(corner);
  const auto potential = [&](double z, double q) {
    reference::ReducedState x = car.make_nominal();
    x.position.z() = at_rest[I::kPosition + 2] + z;
    x.q[c] = at_rest[I::kCorner + corner] + q;
    const reference::ReferenceState state = car.assemble(x);
    const reference::CarEnergy energy = car.calc_energy(state);
    const double deflection = car.calc_contact(state, corner).deflection;
    return energy.springs + energy.gravity + 0.5 * spec.tire.stiffness * deflection * deflection;
  };
  constexpr double h = 1e-3;
  const double v = potential(0.0, 0.0);
  const double zz = (potential(h, 0.0) - 2.0 * v + potential(-h, 0.0)) / (h * h);
  const double qq = (potential(0.0, h) - 2.0 * v + potential(0.0, -h)) / (h * h);
  const double zq =
      (potential(h, h) - potential(h, -h) - potential(-h, h) + potential(-h, -h)) / (4.0 * h * h);
  return zz - zq * zq / qq;
}

TEST_CASE("An axle's ride rate is wheel rate and tire in series", "[unit][reference]") {
  const VehicleSpec spec = reference::make_paper_sedan_spec();
  const PreparedCase c = prepare(make_flat_case(spec));
  const State<double> x = rest(c).state;
  for (const int corner : {kFrontLeft, kRearLeft}) {
    constexpr double kLift = 1e-4;
    const double rate =
        (calc_held_load(c, x, corner, -kLift) - calc_held_load(c, x, corner, kLift)) /
        (2.0 * kLift);
    const double wheel = calc_wheel_rate(spec, c, corner), tire = spec.tire.stiffness;
    const double series = wheel * tire / (wheel + tire);
    const double exact = calc_ride_rate(spec, x, corner);
    INFO("corner " << corner << ": wheel rate " << wheel << " N/m, ride rate " << rate
                   << ", from energies " << exact << ", series " << series);
    // Second differences over 1 mm: h^2 / 12 times fourth derivatives.
    CHECK(rate == Approx(exact).epsilon(tolerance(1e-4)));
    // Left out of the textbook's series: camber change, which shifts the contact point sideways,
    // and the weight of links that turn.
    CHECK(rate == Approx(series).epsilon(tolerance(0.03)));
  }
}

/// Heave, roll, pitch, corners: accelerations by displacement at rest.
Eigen::Matrix<double, 7, 7> linearize(const Vehicle<double>& vehicle,
                                      const State<double>& at_rest) {
  const NewtonClosure<double> closure{&vehicle.layout, &vehicle.numbers};
  Workspace<double> ws{};
  const auto accelerate = [&](int coordinate, double step) {
    State<double> x = at_rest, dx{};
    if (coordinate == 0) x[I::kPosition + 2] += step;
    if (coordinate == 1 || coordinate == 2) x[I::kQuaternion + coordinate] += 0.5 * step;
    if (coordinate > 2) x[I::kCorner + coordinate - 3] += step;
    calc_derivative(vehicle, closure, TireMode::kFrictionless, x.data(), dx.data(), ws);
    Eigen::Matrix<double, 7, 1> a;
    a << (ws.rotation * ws.acceleration).z, dx[I::kAngularVelocity], dx[I::kAngularVelocity + 1],
        dx[I::kCornerRate], dx[I::kCornerRate + 1], dx[I::kCornerRate + 2], dx[I::kCornerRate + 3];
    return a;
  };
  constexpr double kStep = 1e-5;
  Eigen::Matrix<double, 7, 7> jacobian;
  for (int i = 0; i < 7; ++i) {
    jacobian.col(i) = (accelerate(i, kStep) - accelerate(i, -kStep)) / (2.0 * kStep);
  }
  return jacobian;
}

/// Frequencies [rad/s] of the modes in which both sides move alike, ascending.
std::vector<double> find_symmetric_modes(const Eigen::Matrix<double, 7, 7>& jacobian) {
  const Eigen::EigenSolver<Eigen::Matrix<double, 7, 7>> modes(jacobian);
  std::vector<double> frequencies;
  for (int i = 0; i < 7; ++i) {
    const Eigen::Matrix<double, 7, 1> v = modes.eigenvectors().col(i).real();
    const double unlike = std::abs(v[1]) + std::abs(v[3] - v[4]) + std::abs(v[5] - v[6]);
    if (unlike > 1e-3 * v.norm()) continue;
    frequencies.push_back(std::sqrt(-modes.eigenvalues()[i].real()));
  }
  std::sort(frequencies.begin(), frequencies.end());
  return frequencies;
}

/// Mass that follows the wheel: wheel, upright, half of what hangs between chassis and upright.
double calc_unsprung_mass(const SuspensionSpec& axle) {
  double linked = axle.lower_arm.mass;
  for (const RodSpec& rod : axle.rods) linked += rod.mass;
  return axle.wheel_mass + axle.upright.mass + 0.5 * linked;
}

/// Half car of four degrees of freedom, both sides together: body heave and pitch (nose down),
/// heights of the axles. Kinetic energy of the whole car, the unsprung masses' vertical motion
/// moved from the body to the axles.
std::vector<double> calc_half_car_modes(const VehicleSpec& spec, const PreparedCase& c) {
  const WholeCarSpec& whole = spec.whole;
  const double place[] = {whole.centroid_to_front, -whole.centroid_to_rear};
  Eigen::Matrix4d m = Eigen::Matrix4d::Zero(), k = Eigen::Matrix4d::Zero();
  m(0, 0) = whole.mass;
  m(1, 1) = whole.inertia.yy;
  for (int axle = 0; axle < kAxles; ++axle) {
    const double unsprung = 2.0 * calc_unsprung_mass(spec.suspension[axle]);
    Eigen::Vector4d over_axle(1.0, -place[axle], 0.0, 0.0), wheel = Eigen::Vector4d::Zero();
    wheel[2 + axle] = 1.0;
    m += unsprung * (wheel * wheel.transpose() - over_axle * over_axle.transpose());
    const Eigen::Vector4d travel = wheel - over_axle;
    k += 2.0 * calc_wheel_rate(spec, c, 2 * axle) * travel * travel.transpose();
    k += 2.0 * spec.tire.stiffness * wheel * wheel.transpose();
  }
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix4d> modes(k, m);
  std::vector<double> frequencies;
  frequencies.reserve(4);
  for (int i = 0; i < 4; ++i) frequencies.push_back(std::sqrt(modes.eigenvalues()[i]));
  return frequencies;
}

TEST_CASE("Heave and pitch frequencies are those of a linear half car", "[unit][reference]") {
  const VehicleSpec spec = reference::make_paper_sedan_spec();
  PreparedCase c = prepare(make_flat_case(spec));
  const State<double> x = rest(c).state;
  for (auto& tire : c.vehicle.numbers.tire) tire.damping = 0.0;
  for (LinearDamper<double>& damper : c.vehicle.numbers.damper) damper.damping = 0.0;
  fill_strut_elements(c.vehicle);
  const auto modes = find_symmetric_modes(linearize(c.vehicle, x));
  const auto expected = calc_half_car_modes(spec, c);
  REQUIRE(modes.size() == 4);
  for (std::size_t i = 0; i < 4; ++i) {
    INFO("mode " << i << ": " << modes[i] / (2.0 * M_PI) << " Hz, half car "
                 << expected[i] / (2.0 * M_PI) << " Hz");
    // Left out of the half car: the wheels' way forward and back and the horizontal shift of the
    // tire forces as the body pitches (0.4 % of the pitch stiffness). Wheel hop also depends on
    // how arms, rods and the turning upright share in the motion.
    CHECK(modes[i] == Approx(expected[i]).epsilon(tolerance(i < 2 ? 0.02 : 0.05)));
  }
}

/// Derivative at the start of a prepared run on the road.
State<double> calc_start_derivative(const PreparedCase& c, Workspace<double>& ws) {
  State<double> dx{};
  const NewtonClosure<double> closure{&c.vehicle.layout, &c.vehicle.numbers};
  calc_derivative(c.vehicle, closure, TireMode::kRolling, c.start.data(), dx.data(), ws);
  return dx;
}

TEST_CASE("A steadily driven car has no relative acceleration", "[unit]") {
  const Case flat = make_flat_case();
  const PreparedCase c = prepare(flat);
  Workspace<double> ws{};
  const State<double> dx = calc_start_derivative(c, ws);
  const Vec3<double> a = ws.rotation * ws.acceleration;
  const double allowed = tolerance(1e-8);  // error of the solver and of its tables
  CHECK(std::abs(a.z) < allowed);
  CHECK(std::abs(a.y) < allowed);
  for (int i = 0; i < 3; ++i) CHECK(std::abs(dx[I::kAngularVelocity + i]) < allowed);
  for (int corner = 0; corner < kCorners; ++corner) {
    CHECK(std::abs(dx[I::kCornerRate + corner]) < 10.0 * allowed);
    const double steady = a.x * c.start[I::kSpin + corner] / flat.maneuver.speed;
    CHECK(std::abs(dx[I::kSpin + corner] - steady) < 1000.0 * allowed);
  }
}

TEST_CASE("The steady drive force is torque over radius less rolling resistance", "[unit]") {
  const Case flat = make_flat_case();
  const PreparedCase c = prepare(flat);
  Workspace<double> ws{};
  const State<double> dx = calc_start_derivative(c, ws);
  double lost = flat.maneuver.drive_torque, force = 0.0, load = 0.0;
  for (int corner = 0; corner < kCorners; ++corner) {
    force += ws.wrench[corner].fx;
    load += ws.contact[corner].load;
    lost -= ws.wrench[corner].fx * ws.contact[corner].loaded_radius +
            c.vehicle.numbers.inertia[corner].spin_inertia * dx[I::kSpin + corner];
  }
  // QSY1 of the load is rolling resistance.
  const double resistance = flat.vehicle.pacejka.QSY1 * load * flat.vehicle.tire.unloaded_radius;
  INFO("torque lost " << lost << " N m, rolling resistance " << resistance << " N m");
  CHECK(lost == Approx(resistance).epsilon(tolerance(0.05)));
  const double acceleration = (ws.rotation * ws.acceleration).x;
  CHECK(force == Approx(flat.vehicle.whole.mass * acceleration).epsilon(tolerance(1e-3)));
}

TEST_CASE("A steadily driven car keeps height and pitch while its speed rises", "[unit]") {
  Case flat = make_flat_case();
  flat.maneuver.duration = 1.0;
  const PreparedCase c = prepare(flat);
  SamplePlan plan;
  plan.interval = 0.05;
  plan.snapshot = false;
  const LaneResults run = list_kernels().back().run_scalar(c, {}, plan);
  const auto get = [&](int sample, int channel) { return run.get_sample(sample, channel); };
  double height = 0.0, pitch = 0.0;
  for (int i = 0; i < run.sample_count; ++i) {
    height = std::max(
        height, std::abs(get(i, CarChannel::kBodyPositionZ) - get(0, CarChannel::kBodyPositionZ)));
    pitch = std::max(pitch,
                     std::abs(get(i, CarChannel::kPitchAngle) - get(0, CarChannel::kPitchAngle)));
  }
  INFO("height drifts by " << height << " m, pitch by " << pitch << " rad");
  CHECK(height < tolerance(1e-6));
  CHECK(pitch < tolerance(1e-6));
  const double gain = get(run.sample_count - 1, CarChannel::kForwardSpeed) - 20.0;
  CHECK(gain > 0.5);
  CHECK(gain < 500.0 / 0.44 / 1155.0);  // at most all torque into speed
}

}  // namespace
}  // namespace strut
