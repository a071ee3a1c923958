// Test stands against closed forms, the laws they have to obey, and an integrator of its own.
#include "model/rig/rigs.h"

#include <Eigen/Dense>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <vector>

#include "base/math/xsimd_backend.h"
#include "model/car/assemble.h"
#include "model/rig/rig_system.h"
#include "tests/support/test_run.h"

namespace strut {
namespace {

using test::make_plan;
using test::make_steps;
using Quarter = QuarterCarChannel;
using Complex = std::complex<double>;

RigSpec make_quarter_car() {
  RigSpec spec;
  spec.sprung_mass = 2.45;
  spec.unsprung_mass = 1.0;
  spec.stiffness = 900.0;
  spec.damping = 7.5;
  spec.tire_stiffness = 1250.0;
  spec.tire_damping = 5.0;
  spec.gravity = 9.81;
  return spec;
}

RigSpec make_single_mass() {
  RigSpec spec;
  spec.kind = RigKind::kSingleMass;
  spec.sprung_mass = 2.0;
  spec.stiffness = 800.0;
  spec.damping = 6.0;
  return spec;
}

double get_quarter(const LaneResults& run, int sample, int channel) {
  return run.get_sample(sample, channel);
}

/// x_dot = A x of the linear quarter car, x in the order of the state.
Eigen::Matrix4d make_system_matrix(const RigSpec& s) {
  const double mu = s.unsprung_mass, ms = s.sprung_mass, k = s.stiffness, c = s.damping;
  const double kt = s.tire_stiffness, ct = s.tire_damping;
  Eigen::Matrix4d a;
  a << 0, 0, 1, 0,                                     //
      0, 0, 0, 1,                                      //
      -(k + kt) / mu, k / mu, -(c + ct) / mu, c / mu,  //
      k / ms, -k / ms, c / ms, -c / ms;
  return a;
}

/// exp(A t) by its eigenvectors.
Eigen::Vector4d propagate(const Eigen::Matrix4d& a, double t, const Eigen::Vector4d& x0) {
  const Eigen::EigenSolver<Eigen::Matrix4d> modes(a);
  const Eigen::Vector4cd amplitude = modes.eigenvectors().inverse() * x0.cast<Complex>();
  Eigen::Vector4cd x = Eigen::Vector4cd::Zero();
  for (int i = 0; i < 4; ++i) {
    x += amplitude[i] * std::exp(modes.eigenvalues()[i] * t) * modes.eigenvectors().col(i);
  }
  return x.real();
}

/// Complex amplitudes of the two masses for a road r e^(iwt) and an actuator force f e^(iwt).
Eigen::Vector2cd calc_response(const RigSpec& s, double w, double road, double force) {
  const Complex iw(0.0, w);
  const Complex z = s.stiffness + iw * s.damping, zt = s.tire_stiffness + iw * s.tire_damping;
  Eigen::Matrix2cd m;
  m << z + zt - w * w * s.unsprung_mass, -z, -z, z - w * w * s.sprung_mass;
  return m.inverse() * Eigen::Vector2cd(zt * road - force, force);
}

/// A rig that starts in the steady oscillation Re(response e^(iwt) / i) of a sine input.
RigSpec start_steady(RigSpec spec, const Eigen::Vector2cd& response, double w) {
  for (int i = 0; i < 2; ++i) {
    const auto at = static_cast<std::size_t>(i);
    spec.initial_position[at] = response[i].imag();
    spec.initial_velocity[at] = w * response[i].real();
  }
  return spec;
}

TEST_CASE("A quarter car left to itself moves by its modes", "[reference][rigs]") {
  RigSpec spec = make_quarter_car();
  spec.initial_position = {0.004, -0.01};
  spec.initial_velocity = {-0.1, 0.2};
  const LaneResults run = simulate_rig(spec, {}, make_steps(5e-4), make_plan(2.0, 0.01));
  REQUIRE(run.sample_count == 201);
  const Eigen::Matrix4d a = make_system_matrix(spec);
  const Eigen::Vector4d x0(0.004, -0.01, -0.1, 0.2);
  for (int i = 0; i <= 200; ++i) {
    const Eigen::Vector4d x = propagate(a, 0.01 * i, x0);
    // RK4: t w (w h)^4 / 120 of the amplitude, w = 48 rad/s: 3e-7 at 1 s, then damped away.
    CHECK(get_quarter(run, i, Quarter::kUnsprungPosition) == Approx(x[0]).margin(2e-9));
    CHECK(get_quarter(run, i, Quarter::kSprungPosition) == Approx(x[1]).margin(2e-9));
    CHECK(get_quarter(run, i, Quarter::kUnsprungVelocity) == Approx(x[2]).margin(1e-7));
    CHECK(get_quarter(run, i, Quarter::kSprungVelocity) == Approx(x[3]).margin(1e-7));
  }
}

TEST_CASE("A quarter car follows road and actuator by its transfer functions",
          "[reference][rigs]") {
  const double frequency = GENERATE(1.4, 4.0, 10.4), w = 2.0 * std::numbers::pi * frequency;
  const bool by_road = GENERATE(true, false);
  const double road = by_road ? 0.002 : 0.0, force = by_road ? 0.0 : 3.0;
  const Eigen::Vector2cd response = calc_response(make_quarter_car(), w, road, force);
  const RigSpec spec = start_steady(make_quarter_car(), response, w);
  const std::vector<InputSignal> inputs = {make_chirp(by_road ? "road_position" : "actuator_force",
                                                      by_road ? road : force, frequency, frequency,
                                                      2.0)};
  const LaneResults run = simulate_rig(spec, inputs, make_steps(5e-4), make_plan(2.0, 0.005));
  const double scale = std::max(std::abs(response[0]), std::abs(response[1]));
  for (int i = 0; i <= 400; ++i) {
    const Complex turn = std::polar(1.0, 0.005 * w * i);
    const Eigen::Vector2cd x = response * turn;
    // The input's table is good to 1.5e-8, its rate to 1e-6 of the tire damper's small share.
    for (int m = 0; m < 2; ++m) {
      CHECK(get_quarter(run, i, Quarter::kUnsprungPosition + m) ==
            Approx(x[m].imag()).margin(1e-6 * scale));
      CHECK(get_quarter(run, i, Quarter::kUnsprungVelocity + m) ==
            Approx(w * x[m].real()).margin(1e-6 * scale * w));
      CHECK(get_quarter(run, i, Quarter::kUnsprungAcceleration + m) ==
            Approx(-w * w * x[m].imag()).margin(1e-5 * scale * w * w));
    }
    CHECK(get_quarter(run, i, Quarter::kRoadPosition) ==
          Approx(road * turn.imag()).margin(1e-7 * road));
    CHECK(get_quarter(run, i, Quarter::kActuatorForce) ==
          Approx(force * turn.imag()).margin(1e-7 * force));
  }
}

TEST_CASE("A single mass swings as the damped oscillator", "[reference][rigs]") {
  RigSpec spec = make_single_mass();
  spec.gravity = GENERATE(0.0, 9.81);  // only moves the rest position
  spec.initial_position = {0.02, 0.0};
  spec.initial_velocity = {-0.3, 0.0};
  const LaneResults run = simulate_rig(spec, {}, make_steps(1e-3), make_plan(3.0, 0.01));
  const double decay = spec.damping / (2.0 * spec.sprung_mass);
  const double w = std::sqrt(spec.stiffness / spec.sprung_mass - decay * decay);
  const double b = (-0.3 + decay * 0.02) / w;
  for (int i = 0; i <= 300; ++i) {
    const double t = 0.01 * i;
    const double x = std::exp(-decay * t) * (0.02 * std::cos(w * t) + b * std::sin(w * t));
    // RK4: t w (w h)^4 / 120 of the amplitude, w = 20 rad/s.
    CHECK(run.get_sample(i, SingleMassChannel::kPosition) == Approx(x).margin(1e-9));
  }
}

TEST_CASE("A force accelerates a free mass", "[reference][rigs]") {
  RigSpec spec = make_single_mass();
  spec.stiffness = spec.damping = 0.0;
  spec.gravity = 9.81;
  const std::vector<InputSignal> force = {
      make_signal("force", {0.0, 2.0}, {0.0, 40.0}, Interpolation::kLinear)};
  const LaneResults run = simulate_rig(spec, force, make_steps(0.01), make_plan(2.0, 0.1));
  for (int i = 0; i <= 20; ++i) {
    const double t = 0.1 * i;  // a = 10 t - g: RK4 is exact
    CHECK(run.get_sample(i, SingleMassChannel::kPosition) ==
          Approx(10.0 * t * t * t / 6.0 - 9.81 * t * t / 2.0).margin(1e-13));
    CHECK(run.get_sample(i, SingleMassChannel::kForce) == Approx(20.0 * t).margin(1e-13));
  }
}

TEST_CASE("Friction of a guide stops a mass sooner in one direction", "[reference][rigs]") {
  RigSpec spec = make_single_mass();
  spec.stiffness = spec.damping = 0.0;
  spec.guide_friction = 4.0;
  spec.guide_asymmetry = 0.5;
  spec.guide_speed = 1e-3;
  const double sign = GENERATE(1.0, -1.0);
  spec.initial_velocity = {2.0 * sign, 0.0};
  const LaneResults run = simulate_rig(spec, {}, make_steps(1e-4), make_plan(3.0, 0.05));
  // 3 or 1 m/s^2 until the mass stands; tanh is 1 to rounding above 0.02 m/s.
  const double slowing = sign > 0.0 ? 3.0 : 1.0, stop = 2.0 / slowing;
  for (int i = 0; i <= 60; ++i) {
    const double t = std::min(0.05 * i, stop);
    // At rest the smoothed friction lets the mass creep on for a millimeter per second at most.
    const double creep = t < stop - 0.02 ? 1e-9 : 2e-5;
    CHECK(run.get_sample(i, SingleMassChannel::kPosition) ==
          Approx(sign * (2.0 * t - 0.5 * slowing * t * t)).margin(creep));
  }
  CHECK(run.get_sample(0, SingleMassChannel::kGuideForce) == Approx(-sign * slowing * 2.0));
}

TEST_CASE("A guide's friction acts on each mass of a quarter car", "[reference][rigs]") {
  RigSpec spec = make_quarter_car();
  spec.guide_friction = 5.0;
  spec.unsprung_guide_friction = 3.0;
  spec.guide_speed = 1e-3;
  spec.initial_velocity = {-0.5, 0.5};
  const RigSpec* const specs[] = {&spec};
  const Rig<double> rig = make_rig<double>(specs);
  RigSystem<double> system(rig, {});
  auto x = system.make_start();
  std::array<double, 4> with{}, decay{};
  system.calc_derivative(0.0, x.data(), with.data(), decay.data());
  RigSpec free = spec;
  free.guide_friction = free.unsprung_guide_friction = 0.0;
  const RigSpec* const others[] = {&free};
  const Rig<double> plain = make_rig<double>(others);
  RigSystem<double> without(plain, {});
  std::array<double, 4> dx{};
  without.calc_derivative(0.0, x.data(), dx.data(), decay.data());
  CHECK(with[2] - dx[2] == Approx(3.0 / spec.unsprung_mass));
  CHECK(with[3] - dx[3] == Approx(-5.0 / spec.sprung_mass));
}

TEST_CASE("A stand needs the force of the mass that it moves", "[reference][rigs]") {
  RigSpec spec;
  spec.kind = RigKind::kStrutRig;
  spec.stiffness = 1000.0;
  spec.moving_mass = 3.0;
  std::vector<double> times, values;
  for (int i = 0; i <= 20; ++i) {
    times.push_back(0.1 * i);
    values.push_back(0.5 * 0.4 * times.back() * times.back());  // a spline has parabolas exactly
  }
  const LaneResults run =
      simulate_rig(spec, {make_signal("displacement", times, values, Interpolation::kSpline)},
                   make_steps(1e-2), make_plan(2.0, 0.1));
  for (int i = 1; i < 20; ++i) {
    const double x = 0.2 * 0.01 * i * i;
    CHECK(run.get_sample(i, StrutRigChannel::kForce) == Approx(1000.0 * x + 3.0 * 0.4));
    CHECK(run.get_sample(i, StrutRigChannel::kAcceleration) == Approx(0.4));
  }
}

TEST_CASE("Feedback of the states changes a quarter car's transfer functions",
          "[reference][rigs]") {
  RigSpec spec = make_quarter_car();
  spec.deflection_feedback = -150.0;
  spec.sprung_velocity_feedback = -12.0;
  spec.tire_deflection_feedback = 80.0;
  spec.unsprung_velocity_feedback = 4.0;
  const double w = 2.0 * std::numbers::pi * 2.5, road = 0.002;
  const Complex iw(0.0, w);
  const Complex z = spec.stiffness + iw * spec.damping;
  const Complex zt = spec.tire_stiffness + iw * spec.tire_damping;
  const Complex by_unsprung = 150.0 + 80.0 + iw * 4.0, by_sprung = -150.0 - iw * 12.0;
  Eigen::Matrix2cd m;
  m << z + zt - w * w * spec.unsprung_mass + by_unsprung, -z + by_sprung, -z - by_unsprung,
      z - w * w * spec.sprung_mass - by_sprung;
  const Eigen::Vector2cd response =
      m.inverse() * Eigen::Vector2cd((zt + 80.0) * road, -80.0 * road);
  const LaneResults run = simulate_rig(start_steady(spec, response, w),
                                       {make_chirp("road_position", road, 2.5, 2.5, 2.0)},
                                       make_steps(1e-3), make_plan(2.0, 0.02));
  for (int i = 0; i <= 100; ++i) {
    const Complex turn = std::polar(1.0, 0.02 * w * i);
    const Eigen::Vector2cd x = response * turn;
    for (int k = 0; k < 2; ++k) {
      CHECK(get_quarter(run, i, Quarter::kUnsprungPosition + k) ==
            Approx(x[k].imag()).margin(2e-9));
    }
    const Complex force = by_unsprung * x[0] + by_sprung * x[1] - 80.0 * road * turn;
    CHECK(get_quarter(run, i, Quarter::kActuatorForce) == Approx(force.imag()).margin(2e-6));
  }
}

/// Largest error of the positions at the end of steps of `step` [s] under a sine road.
double measure_step_error(double step, Stepper stepper) {
  const double w = 2.0 * std::numbers::pi * 3.0;
  const Eigen::Vector2cd response = calc_response(make_quarter_car(), w, 1.0, 0.0);
  RigSpec spec = start_steady(make_quarter_car(), response, w);
  // Cells of 0.1 ms: the table's error (w h)^4 / 384 is 3e-14.
  std::vector<double> times, values, rates;
  for (int i = 0; i <= 10000; ++i) {
    times.push_back(1e-4 * i);
    values.push_back(std::sin(w * times.back()));
    rates.push_back(w * std::cos(w * times.back()));
  }
  const LaneResults run = simulate_rig(spec, {make_signal("road_position", times, values, rates)},
                                       make_steps(step, stepper), make_plan(1.0, 0.1));
  double error = 0.0;
  for (int i = 0; i <= 10; ++i) {
    const Eigen::Vector2cd x = response * std::polar(1.0, 0.1 * w * i);
    for (int m = 0; m < 2; ++m) {
      const double computed = get_quarter(run, i, Quarter::kUnsprungPosition + m);
      error = std::max(error, std::fabs(computed - x[m].imag()));
    }
  }
  return error;
}

TEST_CASE("Both integrators drive a quarter car with order four", "[property][rigs]") {
  const Stepper stepper = GENERATE(Stepper::kRk4, Stepper::kAbm4);
  const double order =
      std::log2(measure_step_error(2e-3, stepper) / measure_step_error(1e-3, stepper));
  CHECK(order > 3.8);  // 0.2 for the next term, w h = 0.1 for the wheel's mode
  CHECK(order < 4.6);
}

TEST_CASE("A strut rig's force is that of its spring and damper", "[unit][rigs]") {
  RigSpec spec;
  spec.kind = RigKind::kStrutRig;
  spec.stiffness = 40000.0;
  spec.damping = 1980.0;
  std::vector<InputSignal> inputs = {make_chirp("displacement", 0.01865, 1.05, 1.05, 2.0)};
  const bool heated = GENERATE(false, true);
  if (heated) {
    inputs.push_back(
        make_signal("temperature", {0.0, 2.0}, {293.0, 313.0}, Interpolation::kLinear));
  }
  const LaneResults run = simulate_rig(spec, inputs, make_steps(1e-2), make_plan(2.0, 0.005));
  using C = StrutRigChannel;
  for (int i = 0; i <= 400; ++i) {
    const double t = 0.005 * i, w = 2.0 * std::numbers::pi * 1.05;
    const double x = 0.01865 * std::sin(w * t), v = 0.01865 * w * std::cos(w * t);
    // The table's error: 1.5e-8 of 746 N, 1e-6 of 243 N.
    CHECK(run.get_sample(i, C::kForce) == Approx(40000.0 * x + 1980.0 * v).margin(4e-4));
    CHECK(run.get_sample(i, C::kSpringForce) == Approx(40000.0 * x).margin(4e-4));
    CHECK(run.get_sample(i, C::kDisplacement) == Approx(x).margin(1e-9));
    CHECK(run.get_sample(i, C::kVelocity) == Approx(v).margin(3e-7));
    CHECK(run.get_sample(i, C::kTemperature) ==
          Approx(heated ? 293.0 + 10.0 * t : 293.15).epsilon(1e-14));
  }
}

TEST_CASE("Gravity leaves a rig at rest and loads its springs", "[unit][rigs]") {
  RigSpec spec = make_quarter_car();
  spec.unilateral_tire = GENERATE(false, true);
  const InputSignal plateau =
      make_signal("road_position", {0.0, 1.0}, {0.3, 0.3}, Interpolation::kLinear);
  const LaneResults run = simulate_rig(spec, {plateau}, make_steps(1e-3), make_plan(1.0, 0.1));
  for (int i = 0; i <= 10; ++i) {
    // Rounding of forces near 34 N over 1250 N/m.
    CHECK(get_quarter(run, i, Quarter::kUnsprungPosition) == Approx(0.3).epsilon(1e-13));
    CHECK(get_quarter(run, i, Quarter::kSprungPosition) == Approx(0.3).epsilon(1e-13));
    CHECK(get_quarter(run, i, Quarter::kSpringForce) == Approx(2.45 * 9.81).epsilon(1e-12));
    CHECK(get_quarter(run, i, Quarter::kTireForce) == Approx(3.45 * 9.81).epsilon(1e-12));
  }
}

TEST_CASE("Work of road and actuator is stored or dissipated", "[property][rigs]") {
  const RigSpec spec = make_quarter_car();
  const std::vector<InputSignal> inputs = {make_chirp("road_position", 0.004, 1.0, 8.0, 2.0),
                                           make_chirp("actuator_force", 3.0, 3.0, 2.0, 2.0)};
  const double h = 5e-4;
  const int steps = 4000;
  const LaneResults run = simulate_rig(spec, inputs, make_steps(h), make_plan(2.0, h));
  const auto get = [&](int i, int channel) { return get_quarter(run, i, channel); };
  const auto calc_energy = [&](int i) {
    const double vu = get(i, Quarter::kUnsprungVelocity), vs = get(i, Quarter::kSprungVelocity);
    const double spring = get(i, Quarter::kSpringForce);
    const double tire =
        spec.tire_stiffness * (3.45 * 9.81 / 1250.0 + get(i, Quarter::kRoadPosition) -
                               get(i, Quarter::kUnsprungPosition));
    return 0.5 * (vu * vu + 2.45 * vs * vs + spring * spring / 900.0 + tire * tire / 1250.0) +
           9.81 * (get(i, Quarter::kUnsprungPosition) + 2.45 * get(i, Quarter::kSprungPosition));
  };
  double work = 0.0, throughput = 0.0;
  for (int i = 0; i <= steps; ++i) {
    const double vu = get(i, Quarter::kUnsprungVelocity), vs = get(i, Quarter::kSprungVelocity);
    const double vr = get(i, Quarter::kRoadVelocity);
    const double power = get(i, Quarter::kTireForce) * vr +
                         get(i, Quarter::kActuatorForce) * (vs - vu) - 7.5 * (vs - vu) * (vs - vu) -
                         5.0 * (vr - vu) * (vr - vu);
    const double simpson = i == 0 || i == steps ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
    work += simpson * h / 3.0 * power;
    throughput += h * std::fabs(power);
  }
  REQUIRE(throughput > 0.1);
  // Simpson's and RK4's errors are (w h)^4 / 180 with w = 50 rad/s.
  CHECK(calc_energy(steps) - calc_energy(0) == Approx(work).margin(1e-6 * throughput));
}

/// The quarter car on the car's tire law, written anew, with steps so small that events need no
/// care; returns unsprung and sprung position at `duration`.
std::array<double, 2> integrate_bouncing(const RigSpec& s, double velocity, double duration) {
  using State = std::array<double, 4>;
  const auto f = [&](const State& x) -> State {
    const double weight = (s.sprung_mass + s.unsprung_mass) * s.gravity;
    const double d = weight / s.tire_stiffness - x[0];
    const double u = std::fmin(std::fmax(d / 2e-3, 0.0), 1.0);
    const double ramp = std::pow(u, 3) * (10.0 - 15.0 * u + 6.0 * u * u);
    const double tire = std::fmax(s.tire_stiffness * d - s.tire_damping * ramp * x[2], 0.0);
    const double strut =
        s.sprung_mass * s.gravity - s.stiffness * (x[1] - x[0]) - s.damping * (x[3] - x[2]);
    return {x[2], x[3], (tire - strut) / s.unsprung_mass - s.gravity,
            strut / s.sprung_mass - s.gravity};
  };
  const double h = 2e-6;
  State x = {0.0, 0.0, velocity, velocity};
  const auto add = [](const State& a, double scale, const State& b) {
    return State{a[0] + scale * b[0], a[1] + scale * b[1], a[2] + scale * b[2],
                 a[3] + scale * b[3]};
  };
  for (long i = 0, steps = std::lround(duration / h); i < steps; ++i) {  // explicit midpoint rule
    x = add(x, h, f(add(x, 0.5 * h, f(x))));
  }
  return {x[0], x[1]};
}

TEST_CASE("A unilateral tire lifts off, flies and lands", "[reference][rigs]") {
  RigSpec spec = make_quarter_car();
  spec.unilateral_tire = true;
  spec.initial_velocity = {1.5, 1.5};
  const LaneResults run = simulate_rig(spec, {}, make_steps(1e-3), make_plan(0.6, 1e-3));
  CHECK(run.status[0] == 0);
  CHECK(run.event_count >= 2);
  int airborne = 0;
  for (int i = 0; i <= 600; ++i) {
    const double tire = get_quarter(run, i, Quarter::kTireForce);
    CHECK(tire >= 0.0);
    if (tire > 0.0) continue;
    ++airborne;
    const double force = get_quarter(run, i, Quarter::kUnsprungAcceleration) +
                         2.45 * get_quarter(run, i, Quarter::kSprungAcceleration);
    CHECK(force == Approx(-3.45 * 9.81).epsilon(1e-12));  // nothing but gravity from outside
  }
  CHECK(airborne > 100);
  const std::array<double, 2> x = integrate_bouncing(spec, 1.5, 0.6);
  // Steps of 1 ms cross the 2 mm of the damping ramp in one or two: h^4 with a large constant.
  CHECK(get_quarter(run, 600, Quarter::kUnsprungPosition) == Approx(x[0]).margin(1e-6));
  CHECK(get_quarter(run, 600, Quarter::kSprungPosition) == Approx(x[1]).margin(1e-6));
}

TEST_CASE("A bilateral tire pulls", "[unit][rigs]") {
  RigSpec spec = make_quarter_car();
  spec.initial_velocity = {1.5, 1.5};
  const LaneResults run = simulate_rig(spec, {}, make_steps(1e-3), make_plan(0.6, 1e-3));
  double lowest = 0.0;
  for (int i = 0; i <= 600; ++i)
    lowest = std::min(lowest, get_quarter(run, i, Quarter::kTireForce));
  CHECK(lowest < -1.0);
  CHECK(run.event_count == 0);
}

TEST_CASE("Lanes of different rigs repeat each rig in double", "[property][rigs]") {
  constexpr int kWidth = NativeLanes::kWidth;
  const RigKind kind = GENERATE(RigKind::kQuarterCar, RigKind::kSingleMass, RigKind::kStrutRig,
                                RigKind::kGuidedMass);
  const Stepper stepper = GENERATE(Stepper::kRk4, Stepper::kAbm4);
  std::vector<RigSpec> specs(static_cast<std::size_t>(kWidth), make_quarter_car());
  std::array<const RigSpec*, static_cast<std::size_t>(kWidth)> pointers{};
  for (std::size_t lane = 0; lane < specs.size(); ++lane) {
    RigSpec& spec = specs[lane];
    const double factor = 1.0 + 0.1 * static_cast<double>(lane);
    spec.kind = kind;
    spec.unilateral_tire = kind == RigKind::kQuarterCar;
    spec.stiffness *= factor;
    spec.sprung_mass /= factor;
    spec.initial_velocity = {0.8 * factor, 0.8};
    pointers[lane] = &spec;
  }
  const std::string driven = get_rig_info(kind).inputs[0].name;
  const std::vector<InputSignal> inputs = {make_chirp(driven, 0.01, 2.0, 6.0, 1.0)};
  const StepOptions options = make_steps(1e-3, stepper);
  const SamplePlan plan = make_plan(1.0, 0.01);
  const LaneResults lanes = simulate_rigs<NativeLanes>(pointers.data(), inputs, options, plan);
  const int channels = static_cast<int>(get_rig_info(kind).channels.size());
  for (int lane = 0; lane < kWidth; ++lane) {
    const LaneResults one =
        simulate_rig(*pointers[static_cast<std::size_t>(lane)], inputs, options, plan);
    for (int i = 0; i <= 100; ++i) {
      for (int c = 0; c < channels; ++c) {
        const double expected = one.get_sample(i, c);
        CHECK(lanes.get_sample(i, c, lane) == Approx(expected).epsilon(1e-9).margin(1e-9));
      }
    }
  }
}

TEST_CASE("A diverging rig is stopped and disturbs no other", "[unit][rigs]") {
  constexpr int kWidth = NativeLanes::kWidth;
  RigSpec good = make_quarter_car(), bad = make_quarter_car();
  good.initial_velocity = bad.initial_velocity = {0.1, 0.1};
  bad.tire_damping = 1e5;  // stable up to steps of 28 us
  std::array<const RigSpec*, static_cast<std::size_t>(kWidth)> specs;
  specs.fill(&good);
  const StepOptions options = make_steps(1e-3);
  const SamplePlan plan = make_plan(0.5, 0.01);
  const LaneResults alone = simulate_rigs<NativeLanes>(specs.data(), {}, options, plan);
  specs[0] = &bad;
  const LaneResults mixed = simulate_rigs<NativeLanes>(specs.data(), {}, options, plan);
  CHECK(mixed.status[0] == static_cast<int>(RunStatus::kDiverged));
  CHECK(mixed.failure_time[0] < 0.5);
  for (int lane = 1; lane < kWidth; ++lane) {
    CHECK(mixed.status[static_cast<std::size_t>(lane)] == 0);
    for (int i = 0; i <= 50; ++i) {
      CHECK(mixed.get_sample(i, Quarter::kSprungPosition, lane) ==
            alone.get_sample(i, Quarter::kSprungPosition, lane));
    }
  }
}

TEST_CASE("Every kind of rig names as many channels as it reports", "[unit][rigs]") {
  CHECK(get_rig_info(RigKind::kQuarterCar).channels.size() == Quarter::kCount);
  CHECK(get_rig_info(RigKind::kStrutRig).channels.size() == StrutRigChannel::kCount);
  CHECK(get_rig_info(RigKind::kSingleMass).channels.size() == SingleMassChannel::kCount);
  CHECK(get_rig_info(RigKind::kGuidedMass).channels.size() == GuidedMassChannel::kCount);
  CHECK(get_rig_info(RigKind::kQuarterCar).channels[Quarter::kTireForce].name == "tire_force");
  CHECK(get_rig_info(RigKind::kStrutRig).channels[StrutRigChannel::kTemperature].name ==
        "temperature");
  CHECK(get_rig_info(RigKind::kSingleMass).channels[SingleMassChannel::kForce].name == "force");
}

TEST_CASE("Rigs that cannot be are refused by name", "[unit][rigs]") {
  const StepOptions options;
  const SamplePlan plan = make_plan(0.1, 0.0);
  RigSpec spec = make_quarter_car();
  const InputSignal road = make_step("road_position", 0.01, 0.0, 0.1);
  CHECK_THROWS_AS(simulate_rig(spec, {road, road}, options, plan), ModelError);
  CHECK_THROWS_WITH(simulate_rig(spec, {make_step("rod_position", 0.01, 0.0, 0.1)}, options, plan),
                    "input rod_position: unknown; inputs of a quarter_car: road_position, "
                    "actuator_force");
  spec.tire_stiffness = 0.0;
  CHECK_THROWS_WITH(simulate_rig(spec, {road}, options, plan),
                    "tire_stiffness = 0: must lie in (0, 1e+08] N/m");
  RigSpec dyno;
  dyno.kind = RigKind::kStrutRig;
  CHECK_THROWS_WITH(simulate_rig(dyno, {}, options, plan),
                    "input displacement: missing; the motion of a strut_rig needs it");
}

}  // namespace
}  // namespace strut
