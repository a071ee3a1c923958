// Dry friction behind an elastic flank and a play, against closed forms, an integration written
// anew, and its own limits.

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "base/math/xsimd_backend.h"
#include "model/rig/rig_system.h"
#include "tests/support/midpoint.h"
#include "tests/support/test_rig.h"
#include "tests/support/test_run.h"
#include "tests/support/tolerance.h"

namespace strut {
namespace {

using test::make_plan;
using test::make_steps;
using test::tolerance;
using Strut = StrutRigChannel;

constexpr double kDamping = 1500.0, kForce = 80.0, kSlow = 1e-3;

RigSpec make_rig(RigKind kind, double stroke, double play = 0.0, double speed = kSlow) {
  RigSpec spec = test::make_corner_rig(kind);
  spec.effects = {{"strut_friction", "", {kForce, speed, stroke}}};
  if (play > 0.0) spec.effects.push_back({"joint_play", "", {play}});
  return spec;
}

/// Friction at speed v since the strut has been at rest, or has turned from a long motion at -v:
/// ds/dt = v - z |v| with z = s / b outside of the play.
double calc_friction(double t, double v, double b, double p, bool turned) {
  if (!turned) {
    const double crosses = 0.5 * p / v;
    return t < crosses ? 0.0 : kForce * -std::expm1(-v * (t - crosses) / b);
  }
  // From z = -1: dz/dt = (v / b) (1 - z) until the flank is left at z = 0.
  const double leaves = b / v * std::log(2.0), arrives = leaves + p / v;
  if (t < leaves) return kForce * (1.0 - 2.0 * std::exp(-v * t / b));
  return t < arrives ? 0.0 : kForce * -std::expm1(-v * (t - arrives) / b);
}

TEST_CASE("Friction builds up along its flank and falls along it after a reversal",
          "[unit][reference][rigs]") {
  const double b = GENERATE(2e-4, 1e-3, 3e-3), p = GENERATE(0.0, 1e-3), v = GENERATE(0.05, 0.2);
  const double turn = 0.2;
  const InputSignal input = make_signal("displacement", {0.0, turn, 0.5}, {v * turn, 0.0, 0.3 * v},
                                        Interpolation::kLinear);
  const LaneResults run = simulate_rig(make_rig(RigKind::kStrutRig, b, p), {input},
                                       make_steps(1e-5), make_plan(0.4, 1e-3));
  // The damper behind a joint has a contact of its own: what is left is friction alone.
  RigSpec plain = make_rig(RigKind::kStrutRig, b, p);
  plain.effects.erase(plain.effects.begin());
  const LaneResults without = simulate_rig(plain, {input}, make_steps(1e-5), make_plan(0.4, 1e-3));
  for (int i = 0; i <= 400; ++i) {
    const double t = 1e-3 * i - turn;
    if (std::fabs(t) < 1e-9) continue;
    const double friction =
        run.get_sample(i, Strut::kDamperForce) - without.get_sample(i, Strut::kDamperForce);
    const double exact = t < 0.0 ? -kForce : calc_friction(t, v, b, p, true);
    // Steps of 10 us over kinks, and tanh(v / v_s).
    INFO(t);
    CHECK(std::fabs(friction - exact) < tolerance(kForce * (1e-5 * v / b + 1e-4)));
  }
}

TEST_CASE("Friction whose flank vanishes acts by the speed alone", "[property][rigs]") {
  const std::vector<InputSignal> road = {make_bump("road_position", 0.05, 0.1, 0.15)};
  using C = QuarterCarChannel;
  const auto run = [&](double stroke) {
    return simulate_rig(make_rig(RigKind::kQuarterCar, stroke, 0.0, 0.02), road, make_steps(5e-4),
                        make_plan(1.0, 0.01));
  };
  const LaneResults base = run(0.0);
  double last = 1e300;
  for (const double stroke : {3e-3, 1e-3, 3e-4, 1e-4, 1e-6}) {
    const LaneResults elastic = run(stroke);
    REQUIRE(elastic.status[0] == 0);
    double difference = 0.0;
    for (int i = 0; i <= 100; ++i) {
      difference = std::fmax(difference, std::fabs(elastic.get_sample(i, C::kSprungPosition) -
                                                   base.get_sample(i, C::kSprungPosition)));
    }
    INFO(stroke << ": " << difference);
    CHECK(difference < last);
    last = difference;
  }
  CHECK(last < 2e-6);
}

TEST_CASE("A guide with elastic friction holds a mass where it was put", "[reference][rigs]") {
  using C = SingleMassChannel;
  const auto put = [](double position, double stroke) {
    RigSpec spec = test::make_corner_rig(RigKind::kSingleMass);
    spec.guide_friction = kForce;  // 80 N against 20 kN/m: up to 4 mm
    spec.guide_speed = 1e-6;
    spec.guide_stroke = stroke;
    spec.initial_position = {position, 0.0};
    return simulate_rig(spec, {}, make_steps(1e-4), make_plan(2.0, 0.5));
  };
  const double position = GENERATE(3e-3, -3e-3);
  const LaneResults held = put(position, 1e-3);
  for (int i = 0; i <= 4; ++i) {
    CHECK(held.get_sample(i, C::kPosition) == Approx(position).margin(tolerance(3e-6)));
    CHECK(held.get_sample(i, C::kGuideForce) == Approx(2e4 * position).epsilon(tolerance(2e-3)));
  }
  // From 10 mm it moves, and stands where friction holds it.
  const LaneResults moved = put(10e-3, 1e-3);
  const double rest = moved.get_sample(4, C::kPosition);
  CHECK(std::fabs(rest) < 4e-3);
  CHECK(std::fabs(rest) > 1e-4);
  CHECK(moved.get_sample(3, C::kPosition) == Approx(rest).margin(tolerance(1e-5)));
}

TEST_CASE("Friction behind a flank gives back no more than the flank holds",
          "[unit][property][rigs]") {
  const double b = GENERATE(1e-4, 1e-3, 5e-3);
  RigSpec spec = make_rig(RigKind::kSingleMass, b);
  spec.damping = 0.0;
  spec.initial_velocity = {0.6, 0.0};
  using C = SingleMassChannel;
  const LaneResults run = simulate_rig(spec, {}, make_steps(5e-5), make_plan(2.0, 1e-3));
  double before = 1e300, first = 0.0;
  for (int i = 0; i <= 2000; ++i) {
    const double x = run.get_sample(i, C::kPosition), v = run.get_sample(i, C::kVelocity);
    const double z = run.get_sample(i, C::kDamperForce) / kForce;
    const double energy = 150.0 * v * v + 1e4 * x * x + 0.5 * kForce * b * z * z;
    if (i == 0) first = energy;
    CHECK(energy <= before + 1e-6 * first);
    before = energy;
  }
  CHECK(before < 0.8 * first);
}

/// A quarter car with elastic friction and play, written anew, by the midpoint rule.
std::array<double, 2> integrate_anew(double duration, const InputSignal& road, double stroke) {
  using State = std::array<double, 5>;  // wheel, body, their speeds, displacement of the flank
  const double k = 20000.0, c = 1500.0, kt = 200000.0, ct = 100.0, mu = 40.0, ms = 300.0;
  const auto f = [&](double t, const State& x) -> State {
    const SignalPoint<double> z = calc_signal(road, t);
    const double d = x[0] - x[1], v = x[2] - x[3];
    const double slope = std::fabs(v) < 1e-9 ? 0.01 : v / std::tanh(v / 0.01);
    const double strut = k * d + c * v + kForce * x[4] / stroke;
    const double tire = kt * (z.value - x[0]) + ct * (z.rate - x[2]);
    return {x[2], x[3], (tire - strut) / mu, strut / ms, v - x[4] / stroke * slope};
  };
  const State x = test::integrate_by_midpoint<State>(duration, 5e-6, f);
  return {x[0], x[1]};
}

TEST_CASE("A quarter car with elastic friction moves as one written anew",
          "[unit][reference][rigs]") {
  const double b = 5e-4;
  const InputSignal road = make_bump("road_position", 0.02, 0.05, 0.2);
  const LaneResults run = simulate_rig(make_rig(RigKind::kQuarterCar, b, 0.0, 0.01), {road},
                                       make_steps(1e-4), make_plan(0.6, 0.1));
  using C = QuarterCarChannel;
  for (const int sample : {2, 4, 6}) {
    const auto x = integrate_anew(0.1 * sample, road, b);
    INFO(sample);
    CHECK(run.get_sample(sample, C::kUnsprungPosition) == Approx(x[0]).margin(tolerance(2e-6)));
    CHECK(run.get_sample(sample, C::kSprungPosition) == Approx(x[1]).margin(tolerance(2e-6)));
  }
}

}  // namespace
}  // namespace strut
