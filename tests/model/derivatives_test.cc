// Derivatives of runs against differences of runs: of the same integrator, and of SUNDIALS.

#include "model/kernel/derivatives.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <deque>
#include <memory>

#include "model/effects/catalogue.h"
#include "model/model.h"
#include "model/scenario/iso_road.h"
#include "model_files/parameters.h"
#include "tests/support/test_car.h"
#include "tests/support/test_run.h"

namespace strut {
namespace {

using test::tolerance;
using C = CarChannel;
using Names = std::vector<std::string>;

const Names kWear = {"front_stiffness", "rear_stiffness", "front_damping", "rear_damping"};

Case make_case() {
  Case c = test::make_paper_case();
  c.maneuver.duration = 0.9;
  c.maneuver.bump_distance = 3.0;
  return c;
}

IntegrateOptions make_options(Stepper stepper = Stepper::kRk4, bool symmetry = true,
                              double step = 1e-3) {
  IntegrateOptions options;
  options.closure = Closure::kTable;
  options.step = test::make_steps(step, stepper);
  options.symmetry = symmetry;
  return options;
}

/// A prepared case with its neighbors along up to kDirections parameters.
class Family {
 public:
  Family(Case c, const Names& parameters, double relative_step) {
    std::vector<double> steps;
    for (const std::string& name : parameters) {
      const Range& allowed = find_parameter(name).allowed;
      const double base = get_parameter(c, name);
      steps.push_back(relative_step * (base == 0.0 ? 1e-2 : std::fabs(base)));
      const double reach = 2.0 * steps.back();
      set_parameter(c, name, std::clamp(base, allowed.low + reach, allowed.high - reach));
    }
    CasePreparer preparer;
    cases_.push_back(preparer.prepare(c));
    differentiated_.at = &cases_.front();
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      const auto add = [&](double steps_away) {
        Case moved = c;
        set_parameter(moved, parameters[i],
                      get_parameter(c, parameters[i]) + steps_away * steps[i]);
        CasePreparer own = preparer;
        cases_.push_back(own.prepare(moved));
        return &cases_.back();
      };
      const PreparedCase* above = add(0.5);
      differentiated_.along[i] = {above, add(-0.5), steps[i]};
      add(1.0), add(-1.0);
    }
  }
  const DifferentiatedCase& get() const { return differentiated_; }
  const Neighbors& along(std::size_t i) const { return differentiated_.along[i]; }
  /// One half of a step above and below, then one step above and below.
  std::array<const PreparedCase*, 4> list_neighbors(std::size_t i) const {
    const PreparedCase* half[] = {along(i).above, along(i).below};
    const std::size_t first = 1 + 4 * i;
    return {half[0], half[1], &cases_[first + 2], &cases_[first + 3]};
  }

 private:
  std::deque<PreparedCase> cases_;
  DifferentiatedCase differentiated_;
};

LaneResults differentiate(const Family& family, const IntegrateOptions& options) {
  return list_derivative_kernels().front().run(&family.get(), 1, options, test::make_plan(0.01));
}

/// Central differences of a channel by half a step and by a whole one.
struct Differences {
  double fine, coarse;
  /// The error of both extrapolated away.
  double extrapolate() const { return (4.0 * fine - coarse) / 3.0; }
};

struct Comparison {
  double error = 0.0;  // largest of all channels, relative to the channel's largest derivative
  int compared = 0, events = 0;
};

/// Compares the derivatives with central differences over snapshot and history. Samples that an
/// event passes within the step have none.
Comparison compare(const Family& family, std::size_t direction, const LaneResults& exact,
                   const IntegrateOptions& options) {
  constexpr double kRounding = 1e-6;  // of a channel, below which its derivatives have no size
  constexpr double kEvent = 1e-3;
  const LaneResults& slope = exact.slopes[direction];
  const auto neighbors = family.list_neighbors(direction);
  // In pairs, since the narrowest kernel has two lanes.
  const auto run_pair = [&](std::size_t first) {
    return list_kernels().front().run_lanes(&neighbors[first], 2, options, test::make_plan(0.01));
  };
  const std::array<LaneResults, 2> runs = {run_pair(0), run_pair(2)};
  const double step = family.along(direction).distance;
  Comparison comparison;
  bool is_finite = true;
  for (int c = 0; c < C::kCount; ++c) {
    std::vector<Differences> differences;
    std::vector<double> slopes;
    double largest = 1.0;
    const auto add = [&](double value, double exact_slope, const auto& get) {
      is_finite = is_finite && std::isfinite(value + exact_slope);
      largest = std::fmax(largest, std::fabs(value));
      slopes.push_back(exact_slope);
      differences.push_back({(get(0) - get(1)) / step, (get(2) - get(3)) / (2.0 * step)});
    };
    for (int i = 0; i < exact.sample_count; ++i) {
      add(exact.get_sample(i, c), slope.get_sample(i, c), [&](std::size_t run) {
        return runs[run / 2].get_sample(i, c, static_cast<int>(run % 2));
      });
    }
    add(exact.get_snapshot(c), slope.get_snapshot(c),
        [&](std::size_t run) { return runs[run / 2].get_snapshot(c, static_cast<int>(run % 2)); });
    double size = kRounding * largest / step;
    for (const double s : slopes) size = std::fmax(size, std::fabs(s));
    for (std::size_t i = 0; i < slopes.size(); ++i) {
      const Differences& d = differences[i];
      if (std::fabs(d.fine - d.coarse) > kEvent * size) {
        ++comparison.events;
        continue;
      }
      ++comparison.compared;
      // Differences are as good as those of both steps agree.
      const double error =
          (std::fabs(slopes[i] - d.extrapolate()) - std::fabs(d.fine - d.coarse)) / size;
      comparison.error = std::fmax(comparison.error, error);
    }
  }
  REQUIRE(is_finite);
  return comparison;
}

void check_derivatives(const Case& c, const Names& parameters, const IntegrateOptions& options,
                       double limit = 1e-6) {
  const Family family(c, parameters, 1e-4);
  const LaneResults exact = differentiate(family, options);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    INFO(parameters[i]);
    const Comparison comparison = compare(family, i, exact, options);
    CHECK(comparison.error < limit);
    CHECK(comparison.events < 0.01 * comparison.compared);
  }
}

TEST_CASE("Derivatives of a run are central differences of its integrator", "[unit][property]") {
  for (const bool symmetry : {true, false}) {
    for (const Stepper stepper : {Stepper::kRk4, Stepper::kAbm4}) {
      INFO("symmetry " << symmetry << ", stepper " << static_cast<int>(stepper));
      check_derivatives(make_case(), kWear, make_options(stepper, symmetry));
    }
  }
}

/// Differentiates a case by its parameters, and lists those that are not differentiable.
Names check_all(const Case& c, const std::vector<const ParameterInfo*>& parameters) {
  Names excluded, group;
  for (const ParameterInfo* parameter : parameters) {
    const Family family(c, {parameter->name}, 1e-4);
    const bool is_included = is_differentiable(*family.get().at, family.along(0));
    (is_included ? group : excluded).push_back(parameter->name);
    if (group.size() < kDirections && (group.empty() || parameter != parameters.back())) continue;
    // Parameters with little effect: the differences' own rounding, from trims that end at 1e-10.
    check_derivatives(c, group, make_options(), 1e-5);
    group.clear();
  }
  return excluded;
}

TEST_CASE("A car is differentiable by all parameters that keep its tire", "[unit][property]") {
  Case c = make_case();
  c.vehicle.rack_position = 1e-3;  // no event is shared by two wheels
  CHECK(check_all(c, list_parameters_in_use(c)) == Names{"tire_radius"});
}

/// Effects of the motion with their places, but for single corners.
std::vector<std::pair<const EffectInfo*, std::string>> list_symmetric_effects() {
  std::vector<std::pair<const EffectInfo*, std::string>> effects;
  for (const EffectInfo& effect : list_effects()) {
    if (is_of_sensors(effect)) continue;
    for (const std::string& place : list_effect_places(effect, get_car_info())) {
      if (find_corner(place) < 0) effects.emplace_back(&effect, place);
    }
  }
  return effects;
}

/// Parameters of an effect at a place, both of ordinary size.
std::vector<const ParameterInfo*> set_effect(const EffectInfo& effect, const std::string& place,
                                             Case& c) {
  EffectSetting setting{effect.name, place, {}};
  std::vector<const ParameterInfo*> parameters;
  for (const EffectParameter* p : list_effect_parameters(effect, get_car_info())) {
    setting.values.push_back(p->typical);
    parameters.push_back(
        &find_parameter(make_effect_parameter_name(effect, place, *p, get_car_info())));
  }
  if (effect.name == "bump_stop") setting.values[1] = 0.005;
  c.vehicle.effects = {setting};
  return parameters;
}

TEST_CASE("A car is differentiable by the parameters of its effects", "[unit][property][effects]") {
  Names excluded;
  for (const auto& [effect, place] : list_symmetric_effects()) {
    INFO(effect->name << " at " << place);
    Case c = make_case();
    c.maneuver.duration = 0.5;
    const Names own = check_all(c, set_effect(*effect, place, c));
    excluded.insert(excluded.end(), own.begin(), own.end());
  }
  CHECK(excluded.empty());
}

TEST_CASE("Derivatives through relaxing tires, coarse steps and rough roads", "[unit][property]") {
  IntegrateOptions options = make_options(Stepper::kAbm4);
  Case c = make_case();
  SECTION("relaxing tires") { c.vehicle.tire.relaxation = true; }
  SECTION("coarse steps") { options.step.coarse_step = 5e-3; }
  SECTION("a spin as any other state") { options.spin = SpinTreatment::kExplicit; }
  SECTION("a rough road") { c.maneuver.rough.fill({-1.0, 0.2, {1e-3, -2e-3, 3e-3, 1e-3, -1e-3}}); }
  SECTION("a random road") {
    c.maneuver.profile.data = std::make_shared<const RoadProfile>(make_iso_road({16e-6}));
  }
  SECTION("a row of bumps") {
    c.maneuver.road.count = 2;
    c.maneuver.road.spacing = 3.0;
  }
  SECTION("a road with kinks") {
    c.vehicle.tire.contact = ContactKind::kPoint;
    c.maneuver.road.shape = BumpShape::kTrapezoid;
    c.maneuver.road.ramp = 0.15;
    c.maneuver.road.height = 0.03;
  }
  // Kinks and steps that change with the parameter cost the differences a digit.
  check_derivatives(c, kWear, options, 1e-5);
}

/// d(snapshot)/d(parameter) by central differences of CVODE runs, extrapolated.
std::vector<double> differentiate_cvode(const Family& family, std::size_t direction) {
  const auto neighbors = family.list_neighbors(direction);
  std::array<std::vector<double>, 4> snapshot;
  for (std::size_t i = 0; i < 4; ++i) snapshot[i] = run_cvode(*neighbors[i], {}, {}).snapshot;
  const double step = family.along(direction).distance;
  std::vector<double> slope;
  for (std::size_t c = 0; c < snapshot[0].size(); ++c) {
    slope.push_back(Differences{(snapshot[0][c] - snapshot[1][c]) / step,
                                (snapshot[2][c] - snapshot[3][c]) / (2.0 * step)}
                        .extrapolate());
  }
  return slope;
}

TEST_CASE("Derivatives converge to those of CVODE with the order of the integrator",
          "[reference]") {
  Case c = make_case();
  c.maneuver.road.shape = BumpShape::kCosine;  // low and long: no wheel leaves the road
  c.maneuver.road.height = 0.01;
  c.maneuver.road.length = 3.0;
  const Family family(c, kWear, 1e-3);
  std::array<std::vector<double>, 4> truth;
  for (std::size_t i = 0; i < truth.size(); ++i) truth[i] = differentiate_cvode(family, i);
  std::vector<double> errors;
  for (const double step : {8e-3, 4e-3, 2e-3}) {
    const LaneResults exact = differentiate(family, make_options(Stepper::kRk4, true, step));
    double error = 0.0;
    for (const int channel : {C::kBodyPositionZ, C::kBodyVelocityZ, C::kBodyAccelerationZ,
                              C::kPitchAngle, C::kPitchRate}) {
      const auto at = static_cast<std::size_t>(channel);
      double size = 0.0, difference = 0.0;
      for (std::size_t i = 0; i < truth.size(); ++i) {
        const double scale = get_parameter(c, kWear[i]);
        const double slope = exact.slopes[i].get_snapshot(channel);
        size = std::fmax(size, std::fabs(truth[i][at] * scale));
        difference = std::fmax(difference, std::fabs((slope - truth[i][at]) * scale));
      }
      error = std::fmax(error, difference / size);
    }
    errors.push_back(error);
  }
  CAPTURE(errors[0], errors[1], errors[2]);
  CHECK(errors[0] / errors[1] > 10.0);
  CHECK(errors[1] / errors[2] > 10.0);
  CHECK(errors[2] < tolerance(2e-5));
}

TEST_CASE("Every kernel differentiates different cases in its lanes alike", "[unit][property]") {
  const std::vector<double> masses = {0.95, 1.0, 1.05};
  std::deque<Family> families;
  std::vector<DifferentiatedCase> cases;
  for (std::size_t i = 0; i < masses.size(); ++i) {
    Case c = make_case();
    c.vehicle.whole.mass *= masses[i];
    // The second case has no direction but the third.
    families.emplace_back(c, i == 1 ? Names{"mass"} : kWear, 1e-4);
    cases.push_back(families.back().get());
  }
  cases[1].along = {Neighbors{}, Neighbors{}, cases[1].along[0], Neighbors{}};
  const IntegrateOptions options = make_options();
  for (const DerivativeKernel& kernel : list_derivative_kernels()) {
    INFO(kernel.isa);
    const auto lanes = std::min(static_cast<std::size_t>(kernel.lanes), cases.size());
    const LaneResults all =
        kernel.run(cases.data(), static_cast<int>(lanes), options, test::make_plan(0.01));
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const LaneResults alone =
          list_derivative_kernels().front().run(&cases[lane], 1, options, test::make_plan(0.01));
      for (std::size_t i = 0; i < kDirections; ++i) {
        const bool is_null = cases[lane].along[i].above == nullptr;
        double size = 0.0, difference = 0.0;
        for (int sample = 0; sample < alone.sample_count; ++sample) {
          const double slope = alone.slopes[i].get_sample(sample, C::kPitchRate);
          size = std::fmax(size, std::fabs(slope));
          difference = std::fmax(
              difference, std::fabs(slope - all.slopes[i].get_sample(sample, C::kPitchRate,
                                                                     static_cast<int>(lane))));
        }
        CHECK((size == 0.0) == is_null);
        CHECK(difference <= 1e-8 * size);
      }
    }
  }
}

TEST_CASE("What switches an effect on has no derivative", "[unit][effects]") {
  for (const auto& [effect, place] : list_symmetric_effects()) {
    INFO(effect->name << " at " << place);
    Case on = make_case();
    const std::vector<const ParameterInfo*> parameters = set_effect(*effect, place, on);
    if (parameters.empty() || !parameters.front()->is_effect) continue;
    const PreparedCase with = test::prepare(on), without = test::prepare(make_case());
    const bool acts_on_struts =
        with.vehicle.layout.strut_effects != without.vehicle.layout.strut_effects;
    if (!acts_on_struts) continue;
    CHECK(!is_differentiable(without, {&with, &without, 1.0}));
  }
}

TEST_CASE("A parameter of one side of a symmetric car is not differentiable", "[unit]") {
  const Family family(make_case(), {"front_left_stiffness", "front_stiffness"}, 1e-4);
  CHECK(!is_differentiable(*family.get().at, family.along(0)));
  CHECK(is_differentiable(*family.get().at, family.along(1)));
  CHECK_THROWS_AS(differentiate(family, make_options()), ModelError);
}

TEST_CASE("Runs are differentiated with tables as closure", "[unit]") {
  IntegrateOptions options = make_options();
  options.closure = Closure::kNewton;
  CHECK_THROWS_AS(differentiate(Family(make_case(), kWear, 1e-4), options), ModelError);
}

}  // namespace
}  // namespace strut
