#include "model/kernel/stability.h"

#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/support/test_car.h"

namespace strut {
namespace {

using test::tolerance;

PreparedCase prepare_at_speed(double speed) {
  Case c = test::make_paper_case();
  c.maneuver.speed = speed;
  return test::prepare(c);
}

/// The fastest decay of a wheel's spin against its slip, at the start [1/s].
double calc_spin_decay(const PreparedCase& c) {
  const NewtonClosure<double> closure{&c.vehicle.layout, &c.vehicle.numbers};
  CarSystem<double> system(c.vehicle, closure, SpinTreatment::kExplicit, c.trigger_x);
  State<double> dx{};
  double decay[kMaxStiff];
  system.calc_derivative(0.0, c.start.data(), dx.data(), decay);
  const auto& rates = system.workspace().spin_decay;
  return *std::max_element(rates.begin(), rates.end());
}

IntegrateOptions make_options(Stepper stepper, SpinTreatment spin) {
  IntegrateOptions options;
  options.step = {stepper, 0.02, true};
  options.spin = spin;
  return options;
}

TEST_CASE("Explicit RK4 is stable up to its textbook limit over the spin's decay", "[unit]") {
  // |R(z)| = 1 at z = -2.7853 (Hairer & Wanner, IV.2). The wheel pulls the car along a little, the
  // limit is searched to 2 %, and kMaxAmplification allows 0.5 % of growth.
  for (const double speed : {3.0, 20.0}) {
    const PreparedCase c = prepare_at_speed(speed);
    const double limit = find_stable_step(c, make_options(Stepper::kRk4, SpinTreatment::kExplicit));
    CHECK(limit * calc_spin_decay(c) == Approx(2.785).epsilon(tolerance(0.04)));
  }
}

TEST_CASE("Explicit ABM4 is stable up to the limit of its PECE pair", "[unit]") {
  // z = -1.25 on the real axis for the fourth-order pair (Hall & Watt 1976, table 4.4).
  const PreparedCase c = prepare_at_speed(20.0);
  const double limit = find_stable_step(c, make_options(Stepper::kAbm4, SpinTreatment::kExplicit));
  CHECK(limit * calc_spin_decay(c) == Approx(1.25).epsilon(tolerance(0.08)));
}

TEST_CASE("Exponential spin is stable at any step that resolves the car", "[unit]") {
  for (const double speed : {3.0, 20.0}) {
    const PreparedCase c = prepare_at_speed(speed);
    IntegrateOptions options = make_options(Stepper::kRk4, SpinTreatment::kExponential);
    options.step.step = 0.005;
    CHECK(calc_amplification(c, options) - 1.0 <= tolerance(kMaxAmplification - 1.0));
    options.step.stepper = Stepper::kAbm4;
    CHECK(calc_amplification(c, options) - 1.0 <= tolerance(kMaxAmplification - 1.0));
  }
}

}  // namespace
}  // namespace strut
