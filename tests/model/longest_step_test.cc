// Steps that a model's effects need: they resolve the effects, and plain models need none.
#include "model/longest_step.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "model/rig/rig_system.h"
#include "tests/support/test_car.h"

namespace strut {
namespace {

constexpr double kDefaultStep = 1e-3, kExactStep = 1e-3 / 128.0;

RigSpec make_rig(RigKind kind, const EffectSettings& effects) {
  RigSpec rig;
  rig.kind = kind;
  rig.sprung_mass = kind == RigKind::kStrutRig ? 0.0 : 2.5;
  rig.unsprung_mass = kind == RigKind::kQuarterCar ? 1.0 : 0.0;
  rig.stiffness = kind == RigKind::kStrutRig ? 0.0 : 900.0;
  rig.damping = kind == RigKind::kStrutRig ? 1000.0 : 7.5;
  rig.tire_stiffness = 1250.0;
  rig.effects = effects;
  return rig;
}

/// Two seconds of a sine with 20 mm on a stand, 2 mm on a road.
LaneResults run(const RigSpec& rig, double step, double coarse_step) {
  const bool is_stand = rig.kind == RigKind::kStrutRig;
  const std::vector<InputSignal> inputs = {make_chirp(get_rig_info(rig.kind).inputs.front().name,
                                                      is_stand ? 0.02 : 0.002, 1.0, 4.0, 2.0)};
  StepOptions options;
  options.step = step;
  options.coarse_step = coarse_step;
  SamplePlan plan;
  plan.duration = 2.0;
  plan.interval = 0.002;
  LaneResults results = simulate_rig(rig, inputs, options, plan);
  REQUIRE(results.is_done());
  return results;
}

std::vector<double> simulate(const RigSpec& rig, int channel, double step,
                             double coarse_step = 0.0) {
  return run(rig, step, coarse_step).get_history(channel);
}

double measure_distance(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

/// Error of steps as a fraction of the effect.
double measure_error(RigSpec rig, int channel, double step, double coarse_step = 0.0) {
  const std::vector<double> exact = simulate(rig, channel, kExactStep);
  const double error = measure_distance(simulate(rig, channel, step, coarse_step), exact);
  rig.effects.clear();
  return error / measure_distance(simulate(rig, channel, kExactStep), exact);
}

TEST_CASE("The longest step resolves lost strokes, stiff friction and stops", "[reference]") {
  using Quarter = QuarterCarChannel;
  struct {
    RigKind kind;
    EffectSettings effects;
    int channel;
  } const models[] = {
      {RigKind::kStrutRig, {{"damper_leak", "", {1e-4}}}, StrutRigChannel::kForce},
      {RigKind::kStrutRig, {{"joint_play", "", {3e-4}}}, StrutRigChannel::kForce},
      {RigKind::kStrutRig, {{"damper_leak", "", {5e-3}}}, StrutRigChannel::kForce},
      {RigKind::kQuarterCar, {{"damper_leak", "", {1e-4}}}, Quarter::kSprungAcceleration},
      {RigKind::kQuarterCar,
       {{"strut_friction", "", {1.0, 0.001, 0.0}}},
       Quarter::kSprungAcceleration},
      {RigKind::kQuarterCar,
       {{"bump_stop", "", {5e4, 0.0015, 50.0}}},
       Quarter::kSprungAcceleration}};
  for (const auto& model : models) {
    const RigSpec rig = make_rig(model.kind, model.effects);
    INFO(model.effects.front().effect << " " << model.effects.front().values.front());
    const double step = shorten_step(kDefaultStep, calc_longest_step(rig));
    CHECK(measure_error(rig, model.channel, step) < test::tolerance(0.04));
  }
}

TEST_CASE("The default step misses a lost stroke that the longest step resolves", "[reference]") {
  const RigSpec rig = make_rig(RigKind::kStrutRig, {{"damper_leak", "", {5e-5}}});
  CHECK(measure_error(rig, StrutRigChannel::kForce, kDefaultStep) > 0.5);
  CHECK(measure_error(rig, StrutRigChannel::kForce,
                      shorten_step(kDefaultStep, calc_longest_step(rig))) < test::tolerance(0.04));
}

TEST_CASE("Fine steps are taken only where a joint crosses its play", "[reference]") {
  for (const RigKind kind : {RigKind::kStrutRig, RigKind::kQuarterCar}) {
    const int channel = kind == RigKind::kStrutRig ? int{StrutRigChannel::kForce}
                                                   : int{QuarterCarChannel::kSprungAcceleration};
    for (const double play : {2e-5, 1e-4, 3e-4}) {
      const RigSpec rig = make_rig(kind, {{"joint_play", "", {play}}});
      const double coarse = shorten_step(kDefaultStep, calc_longest_settled_step(rig));
      const double fine = shorten_step(coarse, calc_longest_step(rig));
      INFO("kind " << static_cast<int>(kind) << ", play " << play << " m: steps of " << fine
                   << " s");
      REQUIRE(fine < coarse);
      const double alone = measure_error(rig, channel, fine);
      CHECK(measure_error(rig, channel, fine, coarse) < alone + test::tolerance(0.005));
      const LaneResults mixed = run(rig, fine, coarse);
      const auto share = static_cast<double>(mixed.derivative_count) /
                         static_cast<double>(run(rig, fine, 0.0).derivative_count);
      CHECK(share < fine / coarse + 0.25);
      CHECK(std::abs(mixed.get_sample(500, 0) - 1.0) < 1e-9);  // samples stay on their times
    }
  }
}

TEST_CASE("Plain models and soft effects need no step of their own", "[unit]") {
  CHECK(std::isinf(calc_longest_step(make_rig(RigKind::kStrutRig, {}))));
  // Nothing moves by the forces of a strut on a stand.
  CHECK(std::isinf(calc_longest_step(
      make_rig(RigKind::kStrutRig, {{"strut_friction", "", {100.0, 0.001, 0.0}}}))));
  Case car = test::make_paper_case();
  CHECK(std::isinf(calc_longest_step(car)));
  car.vehicle.effects = {{"strut_friction", "front", {50.0, 0.01, 0.0}},
                         {"joint_play", "rear", {0.01}}};
  CHECK(calc_longest_step(car) > kDefaultStep);
  car.vehicle.effects = {{"joint_play", "rear_left", {1e-4}}};
  CHECK(calc_longest_step(car) == Approx(1.2 / std::hypot(1e3, 5e3)));
}

TEST_CASE("Steps are halved", "[unit]") {
  CHECK(shorten_step(1e-3, 1e-3) == 1e-3);
  CHECK(shorten_step(1e-3, 0.9e-3) == 0.5e-3);
  CHECK(shorten_step(2e-3, 0.2e-3) == 0.125e-3);
}

}  // namespace
}  // namespace strut
