// The guided mass against closed forms and an integrator of its own.
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "model/rig/rig_system.h"
#include "tests/support/tolerance.h"

namespace strut {
namespace {

using C = GuidedMassChannel;
constexpr double kPi = std::numbers::pi;

RigSpec make_rig() {
  RigSpec spec;
  spec.kind = RigKind::kGuidedMass;
  spec.sprung_mass = 4.0;
  spec.stiffness = 2500.0;
  spec.damping = 20.0;
  spec.gravity = 9.81;
  return spec;
}

double read(const LaneResults& run, int sample, int channel) {
  return run.get_sample(sample, channel);
}

LaneResults run(const RigSpec& spec, const std::vector<InputSignal>& inputs, double duration,
                double step = 1e-3) {
  StepOptions options;
  options.step = step;
  SamplePlan plan;
  plan.duration = duration;
  plan.interval = 1e-3;
  return simulate_rig(spec, inputs, options, plan);
}

TEST_CASE("A guided mass follows its base as its transmissibility says", "[reference]") {
  const RigSpec spec = make_rig();
  constexpr double kFrequency = 5.0, kAmplitude = 2e-3, kDuration = 8.0;
  const LaneResults shaken =
      run(spec, {make_chirp("base_position", kAmplitude, kFrequency, kFrequency, kDuration)},
          kDuration);
  // z / z_b = (k + i w c) / (k - m w^2 + i w c), once the free motion is gone.
  const double w = 2.0 * kPi * kFrequency;
  const std::complex<double> through(spec.stiffness, w * spec.damping);
  const std::complex<double> ratio = through / (through - spec.sprung_mass * w * w);
  double worst = 0.0;
  for (int i = 7000; i < 8000; ++i) {
    const double expected =
        kAmplitude * std::imag(ratio * std::exp(std::complex<double>(0.0, w * 1e-3 * i)));
    worst = std::max(worst, std::abs(read(shaken, i, C::kPosition) - expected));
  }
  CHECK(std::abs(ratio) > 1.5);
  CHECK(worst < test::tolerance(1e-6) * kAmplitude);
}

TEST_CASE("Dry friction of the guide takes 4 F / k off each swing to and fro", "[reference]") {
  RigSpec spec = make_rig();
  spec.damping = 0.0;
  spec.guide_friction = 2.0;
  spec.guide_speed = 1e-4;  // all but dry
  spec.initial_position[0] = 0.02;
  const LaneResults free = run(spec, {}, 1.0, 1e-5);
  const double period = 2.0 * kPi * std::sqrt(spec.sprung_mass / spec.stiffness);
  const double loss = 4.0 * spec.guide_friction / spec.stiffness;
  for (int swing = 1; swing <= 2; ++swing) {
    const int at = static_cast<int>(std::lround(1e3 * swing * period));
    CHECK(read(free, at, C::kPosition) ==
          Approx(0.02 - swing * loss).epsilon(test::tolerance(2e-3)));
  }
}

TEST_CASE("Friction of the guide acts against the mass and not against the strut", "[property]") {
  RigSpec spec = make_rig();
  spec.guide_friction = 1.5;
  const std::vector<InputSignal> inputs = {make_chirp("base_position", 3e-3, 1.0, 8.0, 2.0),
                                           make_step("force", 4.0, 0.5, 0.1)};
  const LaneResults shaken = run(spec, inputs, 2.0);
  REQUIRE(shaken.status[0] == 0);
  double strongest = 0.0;
  for (int i = 0; i < shaken.sample_count; ++i) {
    const double v = read(shaken, i, C::kVelocity), guide = read(shaken, i, C::kGuideForce);
    CHECK(guide * v <= 0.0);
    strongest = std::max(strongest, std::abs(guide));
    // Newton's law from what the channels say; the spring carries the weight.
    const double forces = read(shaken, i, C::kSpringForce) + read(shaken, i, C::kDamperForce) +
                          read(shaken, i, C::kForce) + guide - spec.sprung_mass * spec.gravity;
    CHECK(read(shaken, i, C::kAcceleration) ==
          Approx(forces / spec.sprung_mass).margin(test::tolerance(1e-9)));
    const double closing = read(shaken, i, C::kBaseVelocity) - v;
    CHECK(read(shaken, i, C::kDamperForce) ==
          Approx(spec.damping * closing).margin(test::tolerance(1e-9)));
  }
  CHECK(strongest == Approx(1.5).epsilon(test::tolerance(1e-3)));
}

TEST_CASE("A guided mass rests on a base that does not move", "[property]") {
  RigSpec spec = make_rig();
  spec.guide_friction = 1.0;
  const LaneResults still = run(spec, {}, 0.5);
  for (int i = 0; i < still.sample_count; ++i) CHECK(read(still, i, C::kPosition) == 0.0);
}

}  // namespace
}  // namespace strut
