// Effects in the car: forces at random states, statics, energy, CVODE, lanes, mirror.

#include <catch2/catch.hpp>
#include <cmath>

#include "model/effects/catalogue.h"
#include "model/model.h"
#include "model_files/parameters.h"
#include "tests/support/test_car.h"
#include "tests/support/test_run.h"

namespace strut {
namespace {

using test::prepare;
using test::tolerance;
using C = CarChannel;
using I = StateIndex;
const ModelInfo& kCar = get_car_info();

/// A one-sided bump, so that roll is excited too.
Case make_case(const EffectSettings& effects = {}) {
  Case c = test::make_paper_case();
  c.vehicle.effects = effects;
  c.maneuver.duration = 0.8;
  c.maneuver.bump_distance = 3.0;
  c.maneuver.road.side = BumpSide::kLeft;
  c.maneuver.road.shape = BumpShape::kCosine;
  c.maneuver.road.height = 0.06;
  c.maneuver.road.length = 1.2;
  return c;
}

IntegrateOptions make_options(double step = 1e-3, Stepper stepper = Stepper::kRk4) {
  IntegrateOptions options;
  options.step.step = step;
  options.step.stepper = stepper;
  options.closure = Closure::kTable;
  return options;
}

const Kernel& scalar() { return list_kernels().back(); }

/// Forces of the struts at a state, by the car's own equations.
std::array<StrutForce<double>, kCorners> calc_struts(const Case& c, const State<double>& x) {
  const PreparedCase p = prepare(c);
  Workspace<double> ws{};
  State<double> dx{};
  const NewtonClosure<double> closure{&p.vehicle.layout, &p.vehicle.numbers};
  calc_derivative(p.vehicle, closure, TireMode::kRolling, x.data(), dx.data(), ws);
  return ws.strut;
}

State<double> make_state(unsigned seed) {
  test::Random random(seed);
  return test::make_random_state(random, 0.5373, 20.0, 0.4673);
}

TEST_CASE("Each corner of a car has the force law of its effects", "[unit][reference][effects]") {
  const double side = 0.35;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const State<double> x = make_state(seed);
    const auto plain = calc_struts(make_case(), x);
    const auto bent = calc_struts(make_case({{"damper_asymmetry", "rear", {side}},
                                             {"strut_friction", "front_left", {90.0, 0.03, 0.0}},
                                             {"bump_stop", "front", {6e4, 0.01, 40.0}},
                                             {"progressive_spring", "rear_right", {70.0}},
                                             {"gas_force", "front_right", {210.0}}}),
                                  x);
    const auto lengths = [&](int corner) {
      const PreparedCase p = prepare(make_case());
      return p.vehicle.numbers.spring[corner].free_length -
             p.vehicle.numbers.nominal_length[corner * kLines + kSpringLine];
    };
    for (int c = 0; c < kCorners; ++c) {
      INFO("seed " << seed << " corner " << c);
      const double k = axle_of(c) == kFront ? 40000.0 : 35000.0, rate = 1980.0;
      const double v = plain[c].damper_force / rate;
      const double d = plain[c].spring_force / k - lengths(c);
      double damper = plain[c].damper_force, spring = plain[c].spring_force;
      if (axle_of(c) == kRear) damper *= v > 0.0 ? 1.0 - side : 1.0 + side;
      if (c == kFrontLeft) damper += 90.0 * std::tanh(v / 0.03);
      if (c == kFrontRight) damper += 210.0;
      const double s = std::fmax(d - 0.01, 0.0);
      if (axle_of(c) == kFront) spring += 6e4 * s * (1.0 + 40.0 * s);
      if (c == kRearRight) spring += k * 70.0 * d * d * d;
      CHECK(bent[c].damper_force == Approx(damper).epsilon(tolerance(1e-11)));
      CHECK(bent[c].spring_force == Approx(spring).epsilon(tolerance(1e-9)));
    }
  }
}

TEST_CASE("An anti-roll bar acts on the difference of an axle's deflections alone",
          "[unit][reference][effects]") {
  const State<double> x = make_state(7);
  const auto plain = calc_struts(make_case(), x);
  const auto bar = calc_struts(make_case({{"anti_roll_bar", "front", {15000.0}}}), x);
  const double twist = (plain[kFrontLeft].spring_force - plain[kFrontRight].spring_force) / 40000.0;
  CHECK(bar[kFrontLeft].energy + bar[kFrontRight].energy - plain[kFrontLeft].energy -
            plain[kFrontRight].energy ==
        Approx(0.5 * 15000.0 * twist * twist).epsilon(tolerance(1e-9)));
  for (int c = 0; c < kCorners; ++c) {
    INFO(c);
    const double added = bar[c].generalized - plain[c].generalized;
    const double ratio = plain[c].generalized / (plain[c].spring_force + plain[c].damper_force);
    // Spring and damper of the front share one line, so one ratio holds for both.
    const double expected = c == kFrontLeft    ? 15000.0 * twist * ratio
                            : c == kFrontRight ? -15000.0 * twist * ratio
                                               : 0.0;
    CHECK(added == Approx(expected).epsilon(tolerance(1e-9)).margin(1e-9));
  }
}

struct Stand {
  State<double> x;
  std::array<double, kCorners> load;
  double axle(int a) const { return load[2 * a] + load[2 * a + 1]; }
};

Stand stand(const EffectSettings& effects) {
  const TrimResult trim = test::rest(prepare(make_case(effects)));
  return {trim.state, trim.load};
}

TEST_CASE("Loads of a car at rest follow payload, center of mass and gas", "[unit][effects]") {
  const Stand plain = stand({});
  const double g = 9.81, mass = 1155.0, base = 0.7209 + 2.0791;
  const Stand loaded = stand({{"payload", "body", {80.0, -1.0, 0.2}}});
  CHECK(loaded.axle(kFront) + loaded.axle(kRear) ==
        Approx((mass + 80.0) * g).epsilon(tolerance(1e-8)));
  // The lever rule at nominal trim; the sinking car turns by some milliradians.
  CHECK(loaded.axle(kRear) - plain.axle(kRear) ==
        Approx(80.0 * g * (0.7209 + 1.0) / base).epsilon(tolerance(0.01)));
  CHECK(loaded.x[I::kPosition + 2] < plain.x[I::kPosition + 2] - 1e-3);
  const Stand shifted = stand({{"center_of_mass_shift", "body", {0.04, 0.0}}});
  CHECK(shifted.axle(kFront) + shifted.axle(kRear) == Approx(mass * g).epsilon(tolerance(1e-8)));
  CHECK(shifted.axle(kFront) - plain.axle(kFront) ==
        Approx(mass * g * 0.04 / base).epsilon(tolerance(0.01)));
  const Stand blown = stand({{"gas_force", "front", {200.0}}, {"gas_force", "rear", {200.0}}});
  CHECK(blown.axle(kFront) == Approx(plain.axle(kFront)).epsilon(tolerance(1e-3)));
  CHECK(blown.x[I::kPosition + 2] > plain.x[I::kPosition + 2] + 2e-3);
}

TEST_CASE("Tires of another stiffness are pressed in as far as their load says",
          "[unit][effects]") {
  const auto calc_deflection = [](const EffectSettings& effects, int corner) {
    const PreparedCase p = prepare(make_case(effects));
    const TrimResult trim = test::rest(p);
    Workspace<double> ws{};
    State<double> dx{};
    const NewtonClosure<double> closure{&p.vehicle.layout, &p.vehicle.numbers};
    calc_derivative(p.vehicle, closure, TireMode::kFrictionless, trim.state.data(), dx.data(), ws);
    return std::array<double, 2>{ws.contact[corner].deflection, ws.contact[corner].load};
  };
  const auto soft = calc_deflection({{"tire_stiffness", "front", {-0.2}}}, kFrontLeft);
  CHECK(soft[0] == Approx(soft[1] / 160000.0).epsilon(tolerance(1e-9)));
  const auto other = calc_deflection({{"tire_stiffness", "front", {-0.2}}}, kRearLeft);
  CHECK(other[0] == Approx(other[1] / 200000.0).epsilon(tolerance(1e-9)));
  const auto hard = calc_deflection({{"tire_progressive", "front", {10.0}}}, kFrontLeft);
  CHECK(hard[1] == Approx(200000.0 * hard[0] * (1.0 + 10.0 * hard[0])).epsilon(tolerance(1e-9)));
}

TEST_CASE("Lift takes load off its axle as the square of the speed", "[unit][effects]") {
  const auto calc_load = [](const EffectSettings& effects, double speed, int axle) {
    Case c = make_case(effects);
    c.maneuver.speed = speed;
    c.maneuver.drive_torque = 0.0;
    const PreparedCase p = prepare(c);
    const TrimResult trim =
        solve_rolling(p.vehicle, p.mechanism->tables, p.mechanism->car.center_height, speed);
    return trim.load[2 * axle] + trim.load[2 * axle + 1];
  };
  for (const double speed : {20.0, 40.0}) {
    const double taken = calc_load({}, speed, kRear) -
                         calc_load({{"aerodynamic_lift", "rear", {0.3}}}, speed, kRear);
    // Half of air's density times area; the pitched body and drag's lever share a little.
    CHECK(taken == Approx(0.6 * 0.3 * speed * speed).epsilon(tolerance(0.01)));
  }
}

/// Final states of two cases, bit for bit.
bool run_alike(const Case& a, const Case& b) {
  const LaneResults x = scalar().run_scalar(prepare(a), make_options(), test::make_plan(0.01));
  const LaneResults y = scalar().run_scalar(prepare(b), make_options(), test::make_plan(0.01));
  return x.final_state == y.final_state && x.snapshot == y.snapshot && x.history == y.history;
}

TEST_CASE("Effects that are numbers of car and maneuver equal those numbers", "[unit][effects]") {
  Case c = make_case();
  const auto with = [](const EffectSetting& effect) { return make_case({effect}); };
  c.maneuver.road.height *= 1.05;
  CHECK(run_alike(with({"bump_height", "road", {0.05}}), c));
  c = make_case();
  c.maneuver.road.length *= 1.1;
  CHECK(run_alike(with({"bump_length", "road", {0.1}}), c));
  c = make_case();
  c.maneuver.road.shape = BumpShape::kTrapezoid;
  Case longer = c;
  longer.vehicle.effects = {{"bump_length", "road", {0.1}}};
  c.maneuver.road.length *= 1.1;
  c.maneuver.road.ramp *= 1.1;
  CHECK(run_alike(longer, c));
  c = make_case();
  c.maneuver.speed *= 1.0 + 0.02;
  CHECK(run_alike(with({"speed_error", "road", {0.02}}), c));
  c = make_case();
  c.vehicle.suspension[kRear].wheel_mass += 4.0;
  CHECK(run_alike(with({"unsprung_mass", "rear", {4.0}}), c));
  c = make_case();
  c.vehicle.tire.footprint += 0.05;
  CHECK(run_alike(with({"tire_enveloping", "road", {0.05}}), c));
  c = make_case();
  c.vehicle.imu_position.x += 0.1;
  CHECK(run_alike(with({"sensor_position", "body", {0.1, 0.0, 0.0}}), c));
}

TEST_CASE("The whole car's pitch inertia is what the effect says", "[unit][effects]") {
  const auto calc_inertia = [](const Case& c) {
    const PreparedCase p = prepare(c);
    Workspace<double> ws{};
    State<double> dx{}, x{};
    x[I::kQuaternion] = 1.0;
    x[I::kPosition + 2] = 0.5373;
    const NewtonClosure<double> closure{&p.vehicle.layout, &p.vehicle.numbers};
    calc_derivative(p.vehicle, closure, TireMode::kFrictionless, x.data(), dx.data(), ws);
    return ws.inertia.yy;
  };
  Case c = make_case();
  c.vehicle.whole.inertia.yy *= 1.08;
  CHECK(calc_inertia(make_case({{"pitch_inertia", "body", {0.08}}})) ==
        Approx(calc_inertia(c)).epsilon(tolerance(1e-12)));
}

/// The car's workspace and derivative at a state.
struct Evaluation {
  Workspace<double> ws{};
  State<double> dx{};
  PreparedCase prepared;
};

Evaluation evaluate(const Case& c, const State<double>& x) {
  Evaluation e{{}, {}, prepare(c)};
  const NewtonClosure<double> closure{&e.prepared.vehicle.layout, &e.prepared.vehicle.numbers};
  calc_derivative(e.prepared.vehicle, closure, TireMode::kRolling, x.data(), e.dx.data(), e.ws);
  return e;
}

TEST_CASE("A payload adds its point's inertia about the chassis origin", "[unit][effects]") {
  State<double> x{};
  x[I::kQuaternion] = 1.0;
  x[I::kPosition + 2] = 0.5373;
  const double mass = 60.0, at_x = -0.5, at_z = 0.1;
  const Evaluation bare = evaluate(make_case(), x);
  const Evaluation loaded = evaluate(make_case({{"payload", "body", {mass, at_x, at_z}}}), x);
  const auto added = [&](double Sym3<double>::*element) {
    return loaded.ws.inertia.*element - bare.ws.inertia.*element;
  };
  CHECK(added(&Sym3<double>::xx) == Approx(mass * at_z * at_z).epsilon(tolerance(1e-9)));
  CHECK(added(&Sym3<double>::yy) ==
        Approx(mass * (at_x * at_x + at_z * at_z)).epsilon(tolerance(1e-9)));
  CHECK(added(&Sym3<double>::zz) == Approx(mass * at_x * at_x).epsilon(tolerance(1e-9)));
}

TEST_CASE("The long radius of an out-of-round wheel presses its tire in", "[unit][effects]") {
  const double amplitude = 3e-4, phase = 0.5, angle = 0.4;
  State<double> x{};
  x[I::kQuaternion] = 1.0;
  x[I::kPosition + 2] = 0.5373;
  for (int c = 0; c < kCorners; ++c) x[I::kWheelAngle + c] = angle;
  const Evaluation round = evaluate(make_case(), x);
  const Evaluation odd = evaluate(make_case({{"wheel_runout", "rear", {amplitude, phase}}}), x);
  for (int c = 0; c < kCorners; ++c) {
    const double wanted = c < 2 ? 0.0 : amplitude * std::cos(angle + phase);
    // The wheel plane leans a little: its radius is longer by its camber's cosine.
    CHECK(odd.ws.contact[c].deflection - round.ws.contact[c].deflection ==
          Approx(wanted).epsilon(tolerance(1e-2)).margin(1e-15));
  }
}

TEST_CASE("Each slip lags by its own relaxation length", "[unit]") {
  Case c = make_case();
  c.vehicle.tire.relaxation = true;
  c.vehicle.pacejka.PTX1 = 2.0;
  c.vehicle.pacejka.PTY1 = 1.2;
  c.vehicle.pacejka.PTY2 = 1.5;
  const State<double> x = make_state(3);
  const Evaluation e = evaluate(c, x);
  for (int corner = 0; corner < kCorners; ++corner) {
    const TireSlipState<double>& slip = e.ws.slip[corner];
    const auto& p = c.vehicle.pacejka;
    const double load = e.ws.contact[corner].load, nominal = p.LFZO * p.FNOMIN;
    const double dfz = load / nominal - 1.0;
    const double camber = dot(e.ws.wheel[corner].axis, e.ws.contact[corner].normal);
    // Longhand; of the scale factors only LFZO is not 1.
    const double kappa_length =
        load * (p.PTX1 + p.PTX2 * dfz) * std::exp(-p.PTX3 * dfz) * p.UNLOADED_RADIUS / p.FNOMIN;
    const double alpha_length = p.PTY1 * std::sin(2.0 * std::atan(load / (p.PTY2 * nominal))) *
                                (1.0 - p.PKY3 * std::abs(camber)) * p.UNLOADED_RADIUS * p.LFZO;
    REQUIRE(kappa_length > 0.1);
    REQUIRE(alpha_length > 0.1);
    REQUIRE(std::abs(kappa_length / alpha_length - 1.0) > 0.05);
    CHECK(e.dx[I::kKappa + corner] ==
          Approx(slip.speed * (slip.kappa - x[I::kKappa + corner]) / kappa_length)
              .epsilon(tolerance(1e-9)));
    CHECK(e.dx[I::kTanAlpha + corner] ==
          Approx(slip.speed * (slip.tan_alpha - x[I::kTanAlpha + corner]) / alpha_length)
              .epsilon(tolerance(1e-9)));
  }
}

EffectSettings make_many() {
  return {{"damper_asymmetry", "front", {0.3}},
          {"damper_blow_off", "rear", {0.5, 0.3}},
          {"damper_hysteresis", "front", {3e-3}},
          {"top_mount_compliance", "rear_left", {2e-6, 2e-3}},
          {"strut_friction", "front", {40.0, 0.05, 0.0}},
          {"progressive_spring", "rear", {60.0}},
          {"bump_stop", "front", {4e4, 0.03, 50.0}},
          {"anti_roll_bar", "front", {12000.0}},
          {"payload", "body", {60.0, -0.5, 0.1}},
          {"tire_progressive", "front", {4.0}},
          {"tire_damping", "rear", {150.0}},
          {"wheel_runout", "rear", {3e-4, 0.5}},
          {"aerodynamic_lift", "rear", {0.2}},
          {"joint_play", "rear_right", {4e-4}}};
}

TEST_CASE("A car with many effects follows CVODE", "[unit][reference][effects]") {
  const Stepper stepper = GENERATE(Stepper::kRk4, Stepper::kAbm4);
  const PreparedCase c = prepare(make_case(make_many()));
  ReferenceOptions reference;
  reference.closure = Closure::kTable;
  reference.relative_tolerance = reference.absolute_tolerance = 1e-11;
  const LaneResults truth = run_cvode(c, reference, test::make_plan(0.02));
  const LaneResults run =
      scalar().run_scalar(c, make_options(2.5e-4, stepper), test::make_plan(0.02));
  REQUIRE(run.status[0] == 0);
  REQUIRE(truth.status[0] == 0);
  for (int i = 0; i < run.sample_count; ++i) {
    for (const int channel : {int{C::kBodyPositionZ}, int{C::kPitchAngle}, int{C::kRollAngle}}) {
      // A micrometer; kinks of damper and stop within steps leave order two.
      CHECK(std::fabs(run.get_sample(i, channel) - truth.get_sample(i, channel)) < tolerance(1e-6));
    }
  }
}

TEST_CASE("Work of all effects' forces is energy", "[unit][property][effects]") {
  const PreparedCase c = prepare(make_case(make_many()));
  const auto calc_balance = [&](const double* x) {
    Workspace<double> ws{};
    State<double> dx{};
    const NewtonClosure<double> closure{&c.vehicle.layout, &c.vehicle.numbers};
    calc_derivative(c.vehicle, closure, TireMode::kRolling, x, dx.data(), ws);
    return calc_energy(c.vehicle, x, ws) - x[I::kWork];
  };
  IntegrateOptions options = make_options(2e-4);
  options.closure = Closure::kNewton;
  const LaneResults run = scalar().run_scalar(c, options, {});
  REQUIRE(run.final_state.size() == static_cast<std::size_t>(I::kCount));
  const double start = calc_balance(c.start.data());
  CHECK(std::fabs(calc_balance(run.final_state.data()) - start) < tolerance(1e-6 * start));
}

/// The same car with left and right exchanged, where the road is.
EffectSettings mirror(EffectSettings effects) {
  for (EffectSetting& e : effects) {
    const std::size_t left = e.place.find("_left"), right = e.place.find("_right");
    if (left != std::string::npos) e.place.replace(left, 5, "_right");
    if (right != std::string::npos) e.place.replace(right, 6, "_left");
  }
  return effects;
}

TEST_CASE("Effects of the left are those of the right in the mirror", "[unit][property][effects]") {
  const EffectSettings effects = {{"damper_asymmetry", "front_left", {0.3}},
                                  {"strut_friction", "rear_right", {50.0, 0.03, 0.0}},
                                  {"bump_stop", "front_right", {4e4, 0.01, 50.0}},
                                  {"damper_hysteresis", "rear_left", {4e-3}},
                                  {"anti_roll_bar", "front", {10000.0}}};
  Case right = make_case(mirror(effects));
  right.maneuver.road.side = BumpSide::kRight;
  const SamplePlan plan = test::make_plan(0.02);
  const LaneResults a = scalar().run_scalar(prepare(make_case(effects)), make_options(), plan);
  const LaneResults b = scalar().run_scalar(prepare(right), make_options(), plan);
  double largest_roll = 0.0;
  for (int i = 0; i < a.sample_count; ++i) {
    const double roll = a.get_sample(i, C::kRollAngle);
    largest_roll = std::fmax(largest_roll, std::fabs(roll));
    CHECK(std::fabs(roll + b.get_sample(i, C::kRollAngle)) < tolerance(1e-10));
    CHECK(std::fabs(a.get_sample(i, C::kBodyPositionZ) - b.get_sample(i, C::kBodyPositionZ)) <
          tolerance(1e-10));
  }
  CHECK(largest_roll > 1e-3);
}

/// A setting of ordinary size for each effect that moves a car, at its first place, strong enough
/// for this road.
EffectSettings list_ordinary() {
  EffectSettings settings;
  for (const EffectInfo& effect : list_effects()) {
    if (list_effect_parameters(effect, kCar).empty() || is_of_sensors(effect)) continue;
    EffectSetting setting{effect.name, list_effect_places(effect, kCar).front(), {}};
    for (const EffectParameter* p : list_effect_parameters(effect, kCar)) {
      setting.values.push_back(p->typical);
    }
    if (effect.name == "bump_stop") setting.values[1] = 0.005;
    settings.push_back(setting);
  }
  return settings;
}

TEST_CASE("An effect moves a car, and neutral it is as if absent, also beside one that is on",
          "[unit][property][effects]") {
  const Kernel& kernel = list_kernels().front();
  const PreparedCase plain = prepare(make_case());
  const SamplePlan plan = test::make_plan(0.05);
  const auto run = [&](const PreparedCase& first, const PreparedCase& others) {
    std::vector<const PreparedCase*> cases(static_cast<std::size_t>(kernel.lanes), &others);
    cases[0] = &first;
    return kernel.run_lanes(cases.data(), kernel.lanes, make_options(), plan);
  };
  const LaneResults absent = run(plain, plain);
  for (const EffectSetting& setting : list_ordinary()) {
    INFO(setting.effect);
    const EffectSetting nothing =
        make_neutral_setting(*find_effect(setting.effect), setting.place, kCar);
    const PreparedCase on = prepare(make_case({setting})), neutral = prepare(make_case({nothing}));
    // Cases of another mechanism fill lanes with tables of their own; the reference must as well.
    const bool same_tables = setting.effect != "unsprung_mass";
    const LaneResults base = same_tables ? absent : run(on, plain);
    const LaneResults both = run(on, neutral);
    const LaneResults alone = kernel.run_scalar(on, make_options(), plan);
    bool moved = false, same = true;
    double error = 0.0;
    for (int i = 0; i < both.sample_count; ++i) {
      for (int channel = 0; channel < C::kCount; ++channel) {
        const double value = both.get_sample(i, channel);
        moved = moved || value != absent.get_sample(i, channel);
        error = std::fmax(
            error, std::fabs(value - alone.get_sample(i, channel)) / (1.0 + std::fabs(value)));
        for (int lane = 1; lane < kernel.lanes; ++lane) {
          same = same && both.get_sample(i, channel, lane) == base.get_sample(i, channel, lane);
        }
      }
    }
    CHECK(moved);
    CHECK(same);
    CHECK(error < tolerance(1e-7));  // forces of thousands of newtons after lift-off events
  }
}

TEST_CASE("An effect at the front moves the front's force first", "[unit][effects]") {
  for (const bool front : {true, false}) {
    const PreparedCase on =
        prepare(make_case({{"damper_asymmetry", front ? "front" : "rear", {0.5}}}));
    const PreparedCase plain = prepare(make_case());
    const SamplePlan plan = test::make_plan(0.01);
    const LaneResults a = scalar().run_scalar(on, make_options(), plan);
    const LaneResults b = scalar().run_scalar(plain, make_options(), plan);
    const auto find_first = [&](int corner) {
      const int channel = C::get_corner_channel(corner, C::kDamperForce);
      int i = 0;
      while (i < a.sample_count &&
             std::fabs(a.get_sample(i, channel) - b.get_sample(i, channel)) < 20.0) {
        ++i;
      }
      return i;
    };
    INFO(front);
    // The left front wheel meets the bump first, a wheelbase before the rear one.
    CHECK((find_first(kFrontLeft) < find_first(kRearLeft)) == front);
  }
}

}  // namespace
}  // namespace strut
