// Effects on the rigs: force laws written anew, transfer functions, energy, order, lanes.

#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>

#include "base/math/xsimd_backend.h"
#include "model/effects/catalogue.h"
#include "model/rig/rig_system.h"
#include "tests/support/midpoint.h"
#include "tests/support/test_car.h"
#include "tests/support/test_rig.h"
#include "tests/support/test_run.h"

namespace strut {
namespace {

using test::make_plan;
using test::make_steps;
using test::tolerance;
using Quarter = QuarterCarChannel;
using Strut = StrutRigChannel;

RigSpec make_rig(RigKind kind, const EffectSettings& effects = {}) {
  RigSpec spec = test::make_corner_rig(kind);
  spec.effects = effects;
  return spec;
}

/// A force law in words of its own: displacement, speed, temperature over 293.15 K.
struct Law {
  EffectSettings effects;
  std::function<double(double d, double v, double warm)> force;
};

double blow_off(double v, double r, double knee) {
  return (1.0 - r) * v + r * v * knee / std::hypot(knee, v);
}

std::vector<Law> list_laws() {
  const double k = 20000.0, c = 1500.0;
  return {
      {{}, [=](double d, double v, double) { return k * d + c * v; }},
      {{{"damper_asymmetry", "", {0.4}}},
       [=](double d, double v, double) { return k * d + (v > 0.0 ? 0.6 : 1.4) * c * v; }},
      {{{"damper_blow_off", "", {0.7, 0.12}}},
       [=](double d, double v, double) { return k * d + c * blow_off(v, 0.7, 0.12); }},
      {{{"damper_fade", "", {0.01}}},
       [=](double d, double v, double warm) {
         return k * d + c * std::pow(0.99004983374916805, warm) * v;
       }},
      {{{"strut_friction", "", {60.0, 0.02, 0.0}}},
       [=](double d, double v, double) { return k * d + c * v + 60.0 * std::tanh(v / 0.02); }},
      {{{"progressive_spring", "", {200.0}}},
       [=](double d, double v, double) { return k * d + k * 200.0 * d * d * d + c * v; }},
      {{{"bump_stop", "", {7e4, 0.02, 60.0}}},
       [=](double d, double v, double) {
         const double s = d > 0.02 ? d - 0.02 : 0.0;
         return k * d + c * v + 7e4 * s + 7e4 * 60.0 * s * s;
       }},
      {{{"gas_force", "", {180.0}}},
       [=](double d, double v, double) { return k * d + c * v + 180.0; }},
      {{{"damper_asymmetry", "", {0.4}}, {"damper_blow_off", "", {0.7, 0.12}}},
       [=](double d, double v, double) {
         return k * d + c * (v > 0.0 ? 0.6 : 1.4) * blow_off(v, 0.7, 0.12);
       }},
  };
}

TEST_CASE("A strut on a dynamometer answers by the law of each effect", "[unit][reference][rigs]") {
  const std::vector<InputSignal> inputs = {
      make_chirp("displacement", 0.04, 0.5, 6.0, 1.0),
      make_signal("temperature", {0.0, 1.0}, {283.15, 343.15}, Interpolation::kLinear)};
  for (const Law& law : list_laws()) {
    INFO((law.effects.empty() ? "none" : law.effects.front().effect));
    const RigSpec spec = make_rig(RigKind::kStrutRig, law.effects);
    const LaneResults run = simulate_rig(spec, inputs, make_steps(0.01), make_plan(1.0, 0.002));
    double largest = 0.0, error = 0.0;
    for (int i = 0; i <= 500; ++i) {
      const auto get = [&](int channel) { return run.get_sample(i, channel); };
      const double expected = law.force(get(Strut::kDisplacement), get(Strut::kVelocity),
                                        get(Strut::kTemperature) - 293.15);
      largest = std::fmax(largest, std::fabs(expected));
      error = std::fmax(error, std::fabs(get(Strut::kForce) - expected));
      CHECK(get(Strut::kSpringForce) + get(Strut::kDamperForce) ==
            Approx(get(Strut::kForce)).margin(1e-9));
    }
    CHECK(error < tolerance(1e-13 * largest));  // rounding of a few products
  }
}

/// Amplitude and phase of the force at a sine of displacement, by projection over whole periods.
std::complex<double> measure_stiffness(const EffectSettings& effects, double frequency) {
  const RigSpec spec = make_rig(RigKind::kStrutRig, effects);
  const double w = 2.0 * std::numbers::pi * frequency, period = 1.0 / frequency;
  const int samples = 200;
  const LaneResults run =
      simulate_rig(spec, {make_chirp("displacement", 0.01, frequency, frequency, 6.0 * period)},
                   make_steps(period / 400.0), make_plan(6.0 * period, period / samples));
  std::complex<double> sum = 0.0;
  for (int i = 5 * samples; i < 6 * samples; ++i) {
    const double t = i * period / samples;
    sum += run.get_sample(i, Strut::kForce) * std::polar(1.0, -w * t);
  }
  // force = Im(K x e^(iwt)): the projection is K x / 2i.
  return sum * std::complex<double>(0.0, 2.0) / (samples * 0.01);
}

TEST_CASE("A lagging damper and a soft mount have their dynamic stiffness",
          "[unit][reference][rigs]") {
  const double frequency = GENERATE(1.0, 12.0, 40.0), w = 2.0 * std::numbers::pi * frequency;
  const std::complex<double> damper(0.0, 1500.0 * w);
  const double tau = 4e-3, kappa = 2e-6, relaxation = 1e-3;
  const std::complex<double> lagged = damper / std::complex<double>(1.0, w * tau);
  const std::complex<double> mount(1.0 / kappa, w * relaxation / kappa);
  const std::complex<double> soft = damper * mount / (damper + mount);
  const EffectSetting lag{"damper_hysteresis", "", {tau}};
  const EffectSetting yield{"top_mount_compliance", "", {kappa, relaxation}};
  // The start's transient fades as exp(-t / tau): gone after five periods of 25 ms; RK4 at 400
  // steps a period.
  CHECK(std::abs(measure_stiffness({lag}, frequency) - 20000.0 - lagged) <
        tolerance(1e-5 * std::abs(damper)));
  CHECK(std::abs(measure_stiffness({yield}, frequency) - 20000.0 - soft) <
        tolerance(1e-5 * std::abs(damper)));
}

TEST_CASE("A lag that vanishes leaves the damper as it is", "[property][rigs]") {
  const RigSpec plain = make_rig(RigKind::kQuarterCar);
  const std::vector<InputSignal> road = {make_bump("road_position", 0.05, 0.1, 0.15)};
  const auto run = [&](const RigSpec& spec) {
    return simulate_rig(spec, road, make_steps(1e-3), make_plan(1.0, 0.01));
  };
  const LaneResults base = run(plain);
  double before = 1e300;
  for (const double lag : {1e-3, 1e-4, 1e-5, 1e-7, 1e-10}) {
    const LaneResults lagging =
        run(make_rig(RigKind::kQuarterCar, {{"damper_hysteresis", "", {lag}}}));
    REQUIRE(lagging.status[0] == 0);
    double difference = 0.0;
    for (int i = 0; i <= 100; ++i) {
      const double sprung = lagging.get_sample(i, Quarter::kSprungPosition);
      difference =
          std::fmax(difference, std::fabs(sprung - base.get_sample(i, Quarter::kSprungPosition)));
    }
    INFO(lag);
    CHECK(difference < before);
    before = difference + 1e-7;
  }
  CHECK(before < 2e-5);  // residual: stages of a step do not share one force
}

/// Time in which the contact behind a lost stroke yields [s].
double calc_contact_time(double p) { return 1.0 / std::hypot(1000.0, 0.5 / p); }

/// Force of a damper that loses a stroke p, `t` after the strut's speed, steady since long, has
/// turned from -v to v.
double calc_reversed_force(double t, double v, double c, double p) {
  const double tau = calc_contact_time(p), leaves = tau * std::numbers::ln2,
               arrives = leaves + p / v;
  if (t < leaves) return c * v * (1.0 - 2.0 * std::exp(-t / tau));
  return t < arrives ? 0.0 : c * v * (1.0 - std::exp(-(t - arrives) / tau));
}

/// Lost strokes by either name, and by both.
std::vector<EffectSettings> list_lost_strokes(double p) {
  return {{{"joint_play", "", {p}}},
          {{"damper_leak", "", {p}}},
          {{"damper_leak", "", {0.75 * p}}, {"joint_play", "", {0.25 * p}}}};
}

TEST_CASE("A damper that loses a stroke is without force until the rod has crossed it",
          "[unit][reference][rigs]") {
  const double p = GENERATE(2e-4, 1e-3, 4e-3), v = GENERATE(0.05, 0.2), turn = 0.1;
  const EffectSettings effects = list_lost_strokes(p)[GENERATE(0U, 1U, 2U)];
  const RigSpec spec = make_rig(RigKind::kStrutRig, effects);
  const InputSignal input = make_signal("displacement", {0.0, turn, 0.4}, {v * turn, 0.0, 0.3 * v},
                                        Interpolation::kLinear);
  const LaneResults run = simulate_rig(spec, {input}, make_steps(1e-5), make_plan(0.3, 5e-4));
  int free = 0;
  for (int i = 0; i <= 600; ++i) {
    const double t = 5e-4 * i - turn, force = run.get_sample(i, Strut::kDamperForce);
    const double exact = t < 0.0 ? -1500.0 * v : calc_reversed_force(t, v, 1500.0, p);
    if (std::fabs(t) < 1e-9) continue;  // the rate is either side's
    free += force == 0.0 ? 1 : 0;
    // Contact is made and lost within steps of 10 us: h / tau of the force at most.
    CHECK(std::fabs(force - exact) < tolerance(1500.0 * v * 1e-5 / calc_contact_time(p) + 1e-9));
  }
  CHECK(free >= static_cast<int>(p / v / 5e-4) - 1);
}

TEST_CASE("Dry friction is behind a worn joint, but acts on while a damper loses its stroke",
          "[unit][reference][rigs]") {
  const double p = 4e-3, v = 0.2, turn = 0.1, c = 1500.0, friction = 40.0, slow = 1e-3;
  const InputSignal input = make_signal("displacement", {0.0, turn, 0.4}, {v * turn, 0.0, 0.3 * v},
                                        Interpolation::kLinear);
  const auto run = [&](const EffectSettings& stroke) {
    EffectSettings effects = stroke;
    effects.push_back({"strut_friction", "", {friction, slow, 0.0}});
    return simulate_rig(make_rig(RigKind::kStrutRig, effects), {input}, make_steps(1e-5),
                        make_plan(0.3, 5e-4));
  };
  const LaneResults worn = run({{"joint_play", "", {p}}});
  const LaneResults leaking = run({{"damper_leak", "", {p}}});
  const LaneResults both = run({{"joint_play", "", {0.5 * p}}, {"damper_leak", "", {0.5 * p}}});
  int behind = 0;
  for (int i = 0; i <= 600; ++i) {
    const double t = 5e-4 * i - turn;
    if (std::fabs(t) < 1e-9) continue;
    const double damper = t < 0.0 ? -c * v : calc_reversed_force(t, v, c, p);
    const double rubs = friction * std::tanh(damper / c / slow);
    const double small = tolerance(1e-5 / calc_contact_time(p) * (c * v + friction * v / slow));
    CHECK(std::fabs(worn.get_sample(i, Strut::kDamperForce) - damper - rubs) < small);
    CHECK(std::fabs(both.get_sample(i, Strut::kDamperForce) - damper - rubs) < small);
    CHECK(std::fabs(leaking.get_sample(i, Strut::kDamperForce) - damper -
                    std::copysign(friction, t)) < small);
    behind += std::fabs(rubs) < 1e-9 ? 1 : 0;
  }
  CHECK(behind >= static_cast<int>(p / v / 5e-4) - 1);
}

TEST_CASE("A joint's play only takes energy", "[unit][property][rigs]") {
  const double p = GENERATE(1e-4, 1e-3, 5e-3);
  RigSpec spec = make_rig(RigKind::kSingleMass, {{"joint_play", "", {p}}});
  spec.initial_velocity = {0.6, 0.0};
  const LaneResults run = simulate_rig(spec, {}, make_steps(1e-4), make_plan(2.0, 1e-3));
  using C = SingleMassChannel;
  double before = 1e300, first = 0.0;
  for (int i = 0; i <= 2000; ++i) {
    const double x = run.get_sample(i, C::kPosition);
    const double v = run.get_sample(i, C::kVelocity);
    const double w = run.get_sample(i, C::kDamperForce) / 1500.0;
    // The contact, a spring of stiffness c / tau, is pressed in by tau w.
    const double tau = calc_contact_time(p);
    const double energy = 150.0 * v * v + 1e4 * x * x + 0.5 * 1500.0 * tau * w * w;
    if (i == 0) first = energy;
    CHECK(energy <= before + 1e-6 * first);  // steps over the contact's kink
    before = energy;
  }
  CHECK(before < 0.1 * first);
}

TEST_CASE("A quarter car answers smoothly to its damper's lost stroke", "[unit][property][rigs]") {
  const std::vector<InputSignal> road = {make_bump("road_position", 0.05, 0.1, 0.15)};
  const auto run = [&](double stroke) {
    return simulate_rig(make_rig(RigKind::kQuarterCar, {{"damper_leak", "", {stroke}}}), road,
                        make_steps(1e-3), make_plan(1.0, 0.01));
  };
  for (const double stroke : {1e-3, 2e-3, 5e-3, 1e-2}) {
    // Slopes over 2 and 20 % of the stroke: what a fit at 1 ms differentiates is no step noise.
    const LaneResults low = run(0.9 * stroke), high = run(1.1 * stroke);
    const LaneResults below = run(0.99 * stroke), above = run(1.01 * stroke);
    double apart = 0.0, size = 0.0;
    for (int i = 0; i <= 100; ++i) {
      const auto get = [&](const LaneResults& r) {
        return r.get_sample(i, Quarter::kSprungPosition);
      };
      const double wide = (get(high) - get(low)) / (0.2 * stroke);
      const double narrow = (get(above) - get(below)) / (0.02 * stroke);
      apart += (wide - narrow) * (wide - narrow);
      size += wide * wide;
    }
    INFO(stroke << ": " << std::sqrt(apart / size));
    CHECK(std::sqrt(apart / size) < 0.1);
  }
}

TEST_CASE("A play that vanishes leaves the damper as it is", "[property][rigs]") {
  const RigSpec plain = make_rig(RigKind::kQuarterCar);
  const std::vector<InputSignal> road = {make_bump("road_position", 0.05, 0.1, 0.15)};
  const auto run = [&](const RigSpec& spec) {
    return simulate_rig(spec, road, make_steps(1e-3), make_plan(1.0, 0.01));
  };
  const LaneResults base = run(plain);
  for (const double play : {3e-3, 1e-3, 3e-4, 1e-4, 1e-5, 1e-7, 1e-10}) {
    const LaneResults loose = run(make_rig(RigKind::kQuarterCar, {{"joint_play", "", {play}}}));
    REQUIRE(loose.status[0] == 0);
    double difference = 0.0;
    for (int i = 0; i <= 100; ++i) {
      const double sprung = loose.get_sample(i, Quarter::kSprungPosition);
      difference =
          std::fmax(difference, std::fabs(sprung - base.get_sample(i, Quarter::kSprungPosition)));
    }
    INFO(play << ": " << difference);
    CHECK(difference < 1.5 * play + 4e-5);  // the rest: stages of a step do not share one force
    CHECK(difference > 0.1 * play);
  }
}

/// The quarter car with effects of every kind, written anew and integrated by the midpoint rule
/// with tiny steps; returns positions at the end.
std::array<double, 2> integrate_anew(double duration, const InputSignal& road) {
  using State = std::array<double, 6>;  // wheel, body, their speeds, lagged force, mount force
  const double g = 9.81, mu = 40.0 + 3.0, ms = 300.0 + 45.0, k = 20000.0, c = 1500.0;
  const double kt = 200000.0 * 1.1, ct = 100.0 + 250.0, q = 5.0;
  const double tau = 2e-3, kappa = 1.5e-6, relaxation = 2e-3;
  const double load = (mu + ms) * g;
  const double sunk = (-1.0 + std::sqrt(1.0 + 4.0 * q * load / kt)) / (2.0 * q);
  const auto f = [&](double t, const State& x) -> State {
    const SignalPoint<double> z = calc_signal(road, t);
    const double d = x[0] - x[1], v = x[2] - x[3];
    const double law = (v > 0.0 ? 0.7 : 1.3) * c * blow_off(v, 0.5, 0.2);
    const double secant = v == 0.0 ? 1.3 * c : std::fabs(law / v);
    const double mount_rate = (x[4] - x[5]) / (relaxation + kappa * secant);
    const double stop = d > 0.03 ? (d - 0.03) * 5e4 * (1.0 + 50.0 * (d - 0.03)) : 0.0;
    const double strut = ms * g + k * d * (1.0 + 60.0 * d * d) + stop + x[5] +
                         relaxation * mount_rate + 40.0 * std::tanh(v / 0.02);
    const double y = sunk + 1.02 * z.value - x[0];
    const double tire = kt * y + kt * q * y * std::fabs(y) + ct * (1.02 * z.rate - x[2]);
    return {x[2], x[3], (tire - strut) / mu - g, strut / ms - g, (law - x[4]) / tau, mount_rate};
  };
  const State x = test::integrate_by_midpoint<State>(duration, 1e-5, f);
  return {x[0], x[1]};
}

TEST_CASE("A quarter car with many effects moves as one written anew", "[unit][reference][rigs]") {
  const EffectSettings effects = {{"damper_asymmetry", "", {0.3}},
                                  {"damper_blow_off", "", {0.5, 0.2}},
                                  {"damper_hysteresis", "", {2e-3}},
                                  {"top_mount_compliance", "", {1.5e-6, 2e-3}},
                                  {"strut_friction", "", {40.0, 0.02, 0.0}},
                                  {"progressive_spring", "", {60.0}},
                                  {"bump_stop", "", {5e4, 0.03, 50.0}},
                                  {"payload", "", {45.0}},
                                  {"unsprung_mass", "", {3.0}},
                                  {"tire_stiffness", "", {0.1}},
                                  {"tire_damping", "", {250.0}},
                                  {"tire_progressive", "", {5.0}},
                                  {"road_gain", "", {0.02}}};
  const RigSpec spec = make_rig(RigKind::kQuarterCar, effects);
  const InputSignal road = make_bump("road_position", 0.08, 0.05, 0.2);
  const LaneResults run = simulate_rig(spec, {road}, make_steps(2.5e-4), make_plan(0.6, 0.05));
  REQUIRE(run.status[0] == 0);
  for (const int sample : {4, 6, 12}) {
    const auto x = integrate_anew(0.05 * sample, road);
    INFO(sample);
    // Kinks at v = 0 and at the stop's contact leave order two: 80 mm times some (w h)^2.
    CHECK(run.get_sample(sample, Quarter::kUnsprungPosition) ==
          Approx(x[0]).margin(tolerance(1e-6)));
    CHECK(run.get_sample(sample, Quarter::kSprungPosition) == Approx(x[1]).margin(tolerance(1e-6)));
  }
}

TEST_CASE("Springs and stops give back what they take", "[unit][property][rigs]") {
  RigSpec spec = make_rig(RigKind::kSingleMass, {{"progressive_spring", "", {80.0}},
                                                 {"bump_stop", "", {7e4, 0.02, 60.0}}});
  spec.damping = 0.0;
  spec.initial_velocity = {0.6, 0.0};
  const LaneResults run = simulate_rig(spec, {}, make_steps(2e-4), make_plan(2.0, 0.005));
  using C = SingleMassChannel;
  const auto calc_energy = [&](int i) {
    const double d = -run.get_sample(i, C::kPosition);
    const double v = run.get_sample(i, C::kVelocity);
    const double s = std::fmax(d - 0.02, 0.0);
    return 150.0 * v * v + 1e4 * d * d + 20000.0 * 80.0 / 4.0 * std::pow(d, 4) + 3.5e4 * s * s +
           7e4 * 60.0 / 3.0 * s * s * s;
  };
  double deepest = 0.0;
  for (int i = 0; i <= 400; ++i) {
    deepest = std::fmax(deepest, -run.get_sample(i, C::kPosition));
    CHECK(calc_energy(i) == Approx(calc_energy(0)).epsilon(tolerance(1e-6)));
  }
  CHECK(deepest > 0.04);
}

TEST_CASE("Dampers and friction only take energy", "[unit][property][rigs]") {
  const EffectSetting effect = GENERATE(EffectSetting{"strut_friction", "", {80.0, 0.01, 0.0}},
                                        EffectSetting{"damper_asymmetry", "", {0.6}},
                                        EffectSetting{"damper_blow_off", "", {0.9, 0.1}},
                                        EffectSetting{"damper_fade", "", {0.5}});
  INFO(effect.effect);
  RigSpec spec = make_rig(RigKind::kSingleMass, {effect});
  spec.damping = effect.effect == "strut_friction" ? 0.0 : 300.0;
  spec.initial_velocity = {0.6, 0.0};
  const LaneResults run = simulate_rig(spec, {}, make_steps(1e-3), make_plan(2.0, 0.002));
  using C = SingleMassChannel;
  double before = 1e300, first = 0.0;
  for (int i = 0; i <= 1000; ++i) {
    const double x = run.get_sample(i, C::kPosition);
    const double v = run.get_sample(i, C::kVelocity);
    const double energy = 150.0 * v * v + 1e4 * x * x;
    if (i == 0) first = energy;
    CHECK(energy <= before + 1e-9 * first);  // RK4's own error
    before = energy;
  }
  CHECK(before < 0.8 * first);
}

/// Largest error of the sprung mass's position against steps of 20 microseconds.
double measure_error(const EffectSettings& effects, double step) {
  const RigSpec spec = make_rig(RigKind::kQuarterCar, effects);
  const std::vector<InputSignal> road = {make_chirp("road_position", 0.01, 1.0, 8.0, 1.0)};
  const auto run = [&](double h) {
    return simulate_rig(spec, road, make_steps(h), make_plan(1.0, 0.1));
  };
  const LaneResults fine = run(2e-5), coarse = run(step);
  double error = 0.0;
  for (int i = 1; i <= 10; ++i) {
    error = std::fmax(error, std::fabs(fine.get_sample(i, Quarter::kSprungPosition) -
                                       coarse.get_sample(i, Quarter::kSprungPosition)));
  }
  return error;
}

TEST_CASE("Smooth effects keep order four, kinks of a force's slope leave two",
          "[unit][property][rigs]") {
  const auto measure_order = [](const EffectSettings& effects) {
    return std::log2(measure_error(effects, 4e-3) / measure_error(effects, 2.5e-4)) / 4.0;
  };
  CHECK(measure_order({{"progressive_spring", "", {100.0}}}) > 3.5);
  CHECK(measure_order({{"damper_blow_off", "", {0.6, 0.3}}}) > 3.5);
  CHECK(measure_order({{"damper_hysteresis", "", {5e-3}}}) > 3.5);
  CHECK(measure_order({{"top_mount_compliance", "", {3e-6, 4e-3}}}) > 3.5);
  // Where a kink falls in a step is a matter of chance; errors scatter about order two.
  CHECK(measure_order({{"damper_asymmetry", "", {0.3}}}) > 1.5);
  CHECK(measure_order({{"bump_stop", "", {5e4, 0.005, 50.0}}}) > 1.5);
  CHECK(measure_error({{"damper_asymmetry", "", {0.3}}}, 1e-3) < 1e-6);
  // A millisecond's step, in which the rod crosses all of the play: less than a tenth of it.
  for (const double play : {1e-4, 3e-4, 1e-3, 5e-3, 3e-2}) {
    INFO(play << ": " << measure_error({{"damper_leak", "", {play}}}, 1e-3));
    CHECK(measure_error({{"damper_leak", "", {play}}}, 1e-3) < 0.1 * play);
  }
}

/// Settings of ordinary size for each effect that moves a rig.
std::vector<EffectSetting> list_ordinary(RigKind kind) {
  std::vector<EffectSetting> settings;
  for (const EffectInfo& effect : list_effects()) {
    const auto parameters = list_effect_parameters(effect, get_rig_info(kind));
    if (parameters.empty() || is_of_sensors(effect)) continue;
    EffectSetting setting{effect.name, "", {}};
    for (const EffectParameter* p : parameters) setting.values.push_back(p->typical);
    if (effect.name == "bump_stop") setting.values[1] = 0.002;  // within this road's reach
    settings.push_back(setting);
  }
  return settings;
}

std::vector<InputSignal> make_input(RigKind kind) {
  const double size = kind == RigKind::kSingleMass ? 500.0 : 0.02;
  std::vector<InputSignal> inputs = {
      make_chirp(get_rig_info(kind).inputs[0].name, size, 1.0, 10.0, 1.0)};
  if (kind == RigKind::kStrutRig) {
    inputs.push_back(
        make_signal("temperature", {0.0, 1.0}, {293.15, 333.15}, Interpolation::kLinear));
  }
  return inputs;
}

TEST_CASE("An effect moves its rig, and neutral it is as if absent, also beside one that is on",
          "[unit][property][rigs]") {
  constexpr int kWidth = NativeLanes::kWidth;
  const RigKind kind = GENERATE(RigKind::kQuarterCar, RigKind::kStrutRig, RigKind::kSingleMass,
                                RigKind::kGuidedMass);
  const RigSpec plain = make_rig(kind);
  const StepOptions options = make_steps(1e-3);
  const SamplePlan plan = make_plan(1.0, 0.01);
  std::array<const RigSpec*, static_cast<std::size_t>(kWidth)> specs;
  specs.fill(&plain);
  const LaneResults absent =
      simulate_rigs<NativeLanes>(specs.data(), make_input(kind), options, plan);
  for (const EffectSetting& setting : list_ordinary(kind)) {
    INFO(setting.effect);
    const ModelInfo& model = get_rig_info(kind);
    const EffectSetting nothing = make_neutral_setting(*find_effect(setting.effect), "", model);
    REQUIRE(is_neutral(nothing, model));
    REQUIRE_FALSE(is_neutral(setting, model));
    const RigSpec on = make_rig(kind, {setting}), neutral = make_rig(kind, {nothing});
    specs.fill(&neutral);
    specs[0] = &on;
    const LaneResults both =
        simulate_rigs<NativeLanes>(specs.data(), make_input(kind), options, plan);
    const LaneResults alone = simulate_rig(on, make_input(kind), options, plan);
    const int channels = static_cast<int>(get_rig_info(kind).channels.size());
    bool moved = false, same = true;
    for (int i = 0; i <= 100; ++i) {
      for (int c = 0; c < channels; ++c) {
        const double value = both.get_sample(i, c);
        moved = moved || value != absent.get_sample(i, c);
        for (int lane = 1; lane < kWidth; ++lane) {
          same = same && both.get_sample(i, c, lane) == absent.get_sample(i, c, lane);
        }
        const double scale = std::fabs(value) + 1.0;
        CHECK(std::fabs(value - alone.get_sample(i, c)) < tolerance(1e-9 * scale));
      }
    }
    CHECK(moved);
    CHECK(same);
  }
}

TEST_CASE("Both integrators hold a stiff lag and a joint in a quarter car", "[unit][rigs]") {
  const Stepper stepper = GENERATE(Stepper::kRk4, Stepper::kAbm4);
  const std::string effect = GENERATE("damper_hysteresis", "joint_play", "damper_leak");
  const double size = GENERATE(1e-9, 1e-5, 2e-4, 1e-2);
  const RigSpec spec = make_rig(RigKind::kQuarterCar, {{effect, "", {size}}});
  const LaneResults run = simulate_rig(spec, {make_bump("road_position", 0.05, 0.1, 0.2)},
                                       make_steps(1e-3, stepper), make_plan(3.0, 0.5));
  CHECK(run.status[0] == 0);
  // Nothing damps within the play.
  const double left = 1e-3 + (effect == "damper_hysteresis" ? 0.0 : size);
  CHECK(std::fabs(run.get_sample(6, Quarter::kSprungPosition)) < left);
}

}  // namespace
}  // namespace strut
