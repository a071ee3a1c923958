// Whole simulations: order, energy, agreement with CVODE, lanes, instruction sets, allocation.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <new>
#include <vector>

#include "model/car/car_system.h"
#include "tests/support/test_car.h"
#include "tests/support/test_run.h"

namespace {
thread_local long allocation_count = 0;
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kCountsAllocations = false;  // sanitizers bring operators of their own
#else
constexpr bool kCountsAllocations = true;
#endif
}  // namespace

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
// Not inlined: GCC would find malloc's memory freed by `delete`.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocation_count;
  if (void* p = std::malloc(size == 0 ? 1 : size)) return p;
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
  ++allocation_count;
  const auto unit = static_cast<std::size_t>(alignment);
  if (void* p = std::aligned_alloc(unit, (size + unit - 1) / unit * unit)) return p;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* p) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::align_val_t) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::size_t, std::align_val_t) noexcept {
  std::free(p);
}
#endif

namespace strut {
namespace {

using C = CarChannel;
using test::make_plan;
using test::tolerance;

IntegrateOptions make_options(Stepper stepper, double step, Closure closure = Closure::kNewton) {
  IntegrateOptions options;
  options.step.stepper = stepper;
  options.step.step = step;
  options.closure = closure;
  return options;
}

const Kernel& widest() { return list_kernels().front(); }

LaneResults run_lanes(const Kernel& kernel, const std::vector<PreparedCase>& cases,
                      const IntegrateOptions& options, const SamplePlan& plan) {
  std::vector<const PreparedCase*> pointers;
  pointers.reserve(cases.size());
  for (const PreparedCase& c : cases) pointers.push_back(&c);
  return kernel.run_lanes(pointers.data(), static_cast<int>(pointers.size()), options, plan);
}

double calc_rms_difference(const LaneResults& a, const LaneResults& b, int channel,
                           int lane_a = 0) {
  double sum = 0.0;
  for (int i = 0; i < a.sample_count; ++i) {
    sum += square(a.get_sample(i, channel, lane_a) - b.get_sample(i, channel));
  }
  return std::sqrt(sum / a.sample_count);
}

double calc_largest_difference(const LaneResults& a, const LaneResults& b, int channel,
                               int lane_a = 0) {
  double largest = 0.0;
  for (int i = 0; i < a.sample_count; ++i) {
    largest =
        std::max(largest, std::abs(a.get_sample(i, channel, lane_a) - b.get_sample(i, channel)));
  }
  return largest;
}

/// Cases over the corners of the paper's grid.
std::vector<PreparedCase> make_grid_cases(int count, const Case& base) {
  CasePreparer preparer;
  std::vector<PreparedCase> cases;
  for (int i = 0; i < count; ++i) {
    Case c = base;
    for (int axle = 0; axle < kAxles; ++axle) {
      for (StrutSpec& strut : c.vehicle.suspension[axle].strut) {
        strut.nominal_stiffness = strut.stiffness;
        strut.stiffness -= ((i >> axle) & 1) * 4500.0 + 100.0 * i;
        strut.damping -= ((i >> (axle + 1)) & 1) * 180.0 + 3.0 * i;
      }
    }
    cases.push_back(preparer.prepare(c));
  }
  return cases;
}

void check_order(Stepper stepper, bool lanes) {
  Case c = test::make_paper_case();
  c.maneuver = test::make_gentle_maneuver();
  const PreparedCase prepared = test::prepare(c);
  const SamplePlan plan = make_plan(0.01);
  // The same corners as the runs: what differs is the integration alone.
  ReferenceOptions reference;
  reference.closure = Closure::kTable;
  reference.relative_tolerance = reference.absolute_tolerance = 1e-13;
  const LaneResults truth = run_cvode(prepared, reference, plan);
  const std::vector<PreparedCase> batch(static_cast<std::size_t>(widest().lanes), prepared);
  const double steps[3] = {1e-3, 5e-4, 2.5e-4};
  double height[3], pitch[3];
  for (int i = 0; i < 3; ++i) {
    const IntegrateOptions options = make_options(stepper, steps[i], Closure::kTable);
    const LaneResults run = lanes ? run_lanes(widest(), batch, options, plan)
                                  : widest().run_scalar(prepared, options, plan);
    CHECK(run.event_count == 0);
    height[i] = calc_rms_difference(run, truth, C::kBodyPositionZ);
    pitch[i] = calc_rms_difference(run, truth, C::kPitchAngle);
  }
  for (const double* error : {height, pitch}) {
    const double order = std::log2(error[0] / error[2]) / 2.0;
    INFO((error == height ? "height" : "pitch")
         << " errors " << std::scientific << error[0] << " " << error[1] << " " << error[2]
         << ", order " << order);
    CHECK(std::abs(order - 4.0) < tolerance(0.2));  // CVODE and rounding: some 3e-13
  }
}

TEST_CASE("RK4 has order four on the full car", "[unit][property]") {
  check_order(Stepper::kRk4, false);
}
TEST_CASE("RK4 has order four on the full car in lanes", "[unit][property]") {
  check_order(Stepper::kRk4, true);
}
TEST_CASE("ABM4 has order four on the full car", "[unit][property]") {
  check_order(Stepper::kAbm4, false);
}
TEST_CASE("ABM4 has order four on the full car in lanes", "[unit][property]") {
  check_order(Stepper::kAbm4, true);
}

/// Energy minus work of non-conservative forces, at a state of `c`.
double calc_balance(const PreparedCase& c, const double* x) {
  Workspace<double> ws{};
  State<double> dx{};
  const NewtonClosure<double> closure{&c.vehicle.layout, &c.vehicle.numbers};
  calc_derivative(c.vehicle, closure, TireMode::kRolling, x, dx.data(), ws);
  return calc_energy(c.vehicle, x, ws) - x[StateIndex::kWork];
}

double calc_energy_error(const PreparedCase& c, Stepper stepper, double step) {
  const LaneResults run = widest().run_scalar(c, make_options(stepper, step), {});
  std::vector<double> x(run.final_state);
  x.resize(StateIndex::kCount);
  const double start = calc_balance(c, c.start.data());
  return std::abs(calc_balance(c, x.data()) - start) / std::abs(start);
}

TEST_CASE("Energy balance closes and its error falls with order four", "[unit][property]") {
  Case c = test::make_paper_case();
  c.maneuver = test::make_gentle_maneuver();
  const PreparedCase prepared = test::prepare(c);
  const Stepper stepper = GENERATE(Stepper::kRk4, Stepper::kAbm4);
  const double coarse = calc_energy_error(prepared, stepper, 2e-3);
  const double fine = calc_energy_error(prepared, stepper, 2.5e-4);
  INFO("relative energy error " << std::scientific << coarse << " at 2 ms, " << fine
                                << " at 0.25 ms");
  CHECK(fine < tolerance(1e-8));
  // Three halvings: 16^3 = 4096; 1e-14 is the rounding of an energy summed over 4000 steps.
  CHECK(fine < tolerance(coarse / 2000.0 + 1e-14));
}

TEST_CASE("Loops stay closed over the paper's run", "[unit][property]") {
  const PreparedCase c = test::prepare(test::make_paper_case());
  const LaneResults run = widest().run_scalar(c, make_options(Stepper::kRk4, 1e-3), {});
  CHECK(run.status[0] == 0);
  INFO("largest loop error " << std::scientific << run.loop_error[0] << " m");
  CHECK(run.loop_error[0] < tolerance(1e-10));
}

void check_against_cvode(Stepper stepper) {
  const PreparedCase c = test::prepare(test::make_paper_case());
  const SamplePlan plan = make_plan(1e-3);
  const LaneResults truth = run_cvode(c, {}, plan);
  for (const double step : {1e-3, 2.5e-4}) {
    const LaneResults run =
        widest().run_scalar(c, make_options(stepper, step, Closure::kTable), plan);
    const double z = calc_largest_difference(run, truth, C::kBodyPositionZ);
    const double pitch = calc_largest_difference(run, truth, C::kPitchAngle);
    const double event = std::abs(run.event_time[0] - truth.event_time[0]);
    const double acceleration = calc_rms_difference(run, truth, C::kBodyAccelerationZ);
    INFO("step " << step << " s: height " << std::scientific << z << " m, pitch " << pitch
                 << " rad, event " << event << " s, body acceleration rms " << acceleration
                 << " m/s^2");
    // 1 ms is only reported, with a bound that a lost order would break.
    CHECK(z < tolerance(step < 5e-4 ? 1e-6 : 2e-5));
    CHECK(pitch < tolerance(step < 5e-4 ? 1e-6 : 2e-5));
    for (int corner = 0; corner < kCorners; ++corner) {
      const int wheel = C::get_corner_channel(corner, C::kWheelPositionZ);
      CHECK(calc_largest_difference(run, truth, wheel) < tolerance(step < 5e-4 ? 1e-6 : 5e-5));
    }
  }
}

TEST_CASE("RK4 over the bump follows CVODE to a micrometer at 0.25 ms", "[unit][reference]") {
  check_against_cvode(Stepper::kRk4);
}
TEST_CASE("ABM4 over the bump follows CVODE to a micrometer at 0.25 ms", "[unit][reference]") {
  check_against_cvode(Stepper::kAbm4);
}

TEST_CASE("A crossing at 3 m/s is as accurate as one at 20", "[unit][reference]") {
  // Spin against slip is seven times stiffer here: 1 ms is far beyond the explicit limit.
  Case c = test::make_paper_case();
  c.maneuver.speed = 3.0;
  c.maneuver.bump_distance = 1.5;
  c.maneuver.duration = 2.0;
  const PreparedCase prepared = test::prepare(c);
  const SamplePlan plan = make_plan(1e-3);
  const LaneResults truth = run_cvode(prepared, {}, plan);
  const Stepper stepper = GENERATE(Stepper::kRk4, Stepper::kAbm4);
  const LaneResults run =
      widest().run_scalar(prepared, make_options(stepper, 1e-3, Closure::kTable), plan);
  CHECK(run.status[0] == 0);
  const double z = calc_largest_difference(run, truth, C::kBodyPositionZ);
  INFO("height " << std::scientific << z << " m");
  CHECK(z < tolerance(2e-5));
}

TEST_CASE("Coarse steps away from the bump cost less than a tenth of a percent",
          "[unit][reference]") {
  const PreparedCase c = test::prepare(test::make_paper_case());
  const SamplePlan plan = make_plan(1e-3);
  const LaneResults truth = run_cvode(c, {}, plan);
  double size = 0.0;
  for (int i = 0; i < truth.sample_count; ++i) {
    size += square(truth.get_sample(i, C::kBodyAccelerationZ));
  }
  size = std::sqrt(size / truth.sample_count);
  IntegrateOptions options = make_options(Stepper::kRk4, 1.5e-3, Closure::kTable);
  const long fine = widest().run_scalar(c, options, {}).derivative_count;
  options.step.coarse_step = 6e-3;
  const LaneResults run = widest().run_scalar(c, options, plan);
  const double error = calc_rms_difference(run, truth, C::kBodyAccelerationZ) / size;
  INFO("body acceleration, rms relative " << std::scientific << error);
  CHECK(error < tolerance(1e-3));
  CHECK(std::abs(run.event_time[0] - truth.event_time[0]) < tolerance(1e-5));
  CHECK(widest().run_scalar(c, options, {}).derivative_count < fine / 2);
}

TEST_CASE("Tabulated corners give the same run as Newton closure", "[unit][property]") {
  const PreparedCase c = test::prepare(test::make_paper_case());
  const SamplePlan plan = make_plan(0.01);
  const LaneResults newton = widest().run_scalar(c, make_options(Stepper::kRk4, 1e-3), plan);
  const LaneResults table =
      widest().run_scalar(c, make_options(Stepper::kRk4, 1e-3, Closure::kTable), plan);
  // The tables' 1e-11 grows by the sensitivity of contact events.
  CHECK(calc_largest_difference(newton, table, C::kBodyPositionZ) < tolerance(1e-9));
  CHECK(calc_largest_difference(newton, table, C::kPitchAngle) < tolerance(1e-9));
  for (int channel = 0; channel < C::kCount; ++channel) {
    double scale = 1.0;
    for (int i = 0; i < table.sample_count; ++i) {
      scale = std::max(scale, std::abs(table.get_sample(i, channel)));
    }
    CAPTURE(list_car_channels()[static_cast<std::size_t>(channel)].name);
    CHECK(calc_largest_difference(newton, table, channel) < tolerance(1e-8 * scale));
  }
}

TEST_CASE("Lanes equal double in every instruction set", "[unit][property]") {
  const SamplePlan plan = make_plan(0.01);
  const Closure closure = GENERATE(Closure::kNewton, Closure::kTable);
  const Stepper stepper = GENERATE(Stepper::kRk4, Stepper::kAbm4);
  Case c = test::make_paper_case();
  c.maneuver.duration = 1.0;
  const IntegrateOptions options = make_options(stepper, 1e-3, closure);
  const std::vector<PreparedCase> cases = make_grid_cases(8, c);
  const Kernel& scalar = list_kernels().back();
  for (const Kernel& kernel : list_kernels()) {
    const std::vector<PreparedCase> batch(cases.begin(), cases.begin() + kernel.lanes);
    const LaneResults lanes = run_lanes(kernel, batch, options, plan);
    for (int lane = 0; lane < kernel.lanes; ++lane) {
      const auto at = static_cast<std::size_t>(lane);
      const LaneResults alone = scalar.run_scalar(cases[at], options, plan);
      CAPTURE(kernel.isa, lane);
      CHECK(calc_largest_difference(lanes, alone, C::kBodyPositionZ, lane) < tolerance(1e-9));
      CHECK(calc_largest_difference(lanes, alone, C::kPitchAngle, lane) < tolerance(1e-9));
      CHECK(std::abs(lanes.event_time[at] - alone.event_time[0]) < tolerance(1e-9));
    }
  }
}

TEST_CASE("A case's bits do not depend on its lane or its neighbours", "[unit][property]") {
  const SamplePlan plan = make_plan(0.01);
  const Stepper stepper = GENERATE(Stepper::kRk4, Stepper::kAbm4);
  const IntegrateOptions options = make_options(stepper, 1e-3, Closure::kTable);
  std::vector<PreparedCase> cases = make_grid_cases(widest().lanes, test::make_paper_case());
  const LaneResults first = run_lanes(widest(), cases, options, plan);
  std::vector<PreparedCase> turned(cases.rbegin(), cases.rend());
  // One neighbour diverges at once.
  turned[0].vehicle.numbers.damper[0].damping = std::nan("");
  turned[0].start[StateIndex::kVelocity] = std::numeric_limits<double>::infinity();
  const LaneResults second = run_lanes(widest(), turned, options, plan);
  const int last = widest().lanes - 1;
  CHECK(second.status[0] == static_cast<int>(RunStatus::kDiverged));
  CHECK(second.failure_time[0] == 0.0);
  for (int lane = 0; lane < last; ++lane) {
    const int other = last - lane;
    CAPTURE(lane);
    CHECK(first.status[static_cast<std::size_t>(lane)] == 0);
    CHECK(second.status[static_cast<std::size_t>(other)] == 0);
    bool same = true;
    for (int i = 0; i < first.sample_count; ++i) {
      for (int channel = 0; channel < C::kCount; ++channel) {
        same = same && first.get_sample(i, channel, lane) == second.get_sample(i, channel, other);
      }
    }
    CHECK(same);
    CHECK(first.event_time[static_cast<std::size_t>(lane)] ==
          second.event_time[static_cast<std::size_t>(other)]);
  }
}

TEST_CASE("Different mechanisms share lanes with tables of their own", "[unit][property]") {
  std::vector<PreparedCase> cases;
  for (int i = 0; i < widest().lanes; ++i) {
    Case c = test::make_paper_case();
    c.maneuver.duration = 0.8;
    c.vehicle.suspension[kRear].wheel_mass += 0.5 * i;
    c.maneuver.road.height -= 0.002 * i;
    cases.push_back(test::prepare(c));
  }
  const SamplePlan plan = make_plan(0.01);
  const IntegrateOptions options = make_options(Stepper::kRk4, 1e-3, Closure::kTable);
  const LaneResults lanes = run_lanes(widest(), cases, options, plan);
  for (int lane = 0; lane < widest().lanes; ++lane) {
    const LaneResults alone =
        widest().run_scalar(cases[static_cast<std::size_t>(lane)], options, plan);
    CHECK(calc_largest_difference(lanes, alone, C::kBodyPositionZ, lane) < tolerance(1e-9));
  }
}

TEST_CASE("A step allocates nothing", "[unit][property]") {
  if (!kCountsAllocations) {
    WARN("skipped: a sanitizer holds the allocator");
    return;
  }
  Case c = test::make_paper_case();
  const Closure closure = GENERATE(Closure::kNewton, Closure::kTable);
  const Stepper stepper = GENERATE(Stepper::kRk4, Stepper::kAbm4);
  const bool with_history = GENERATE(false, true);
  if (with_history) {
    c.vehicle.effects = {{"damper_hysteresis", "rear", {2e-3}},
                         {"strut_friction", "front", {30.0, 0.02, 0.0}},
                         {"wheel_runout", "front_left", {1e-4, 0.0}}};
  }
  const IntegrateOptions options = make_options(stepper, 1e-3, closure);
  // Both contain the snapshot, the second twice the steps; as many samples, so that the history
  // takes as much memory.
  const double durations[2] = {0.7, 1.4}, intervals[2] = {0.01, 0.02};
  long counts[2];
  int samples[2];
  for (int i = 0; i < 2; ++i) {
    c.maneuver.duration = durations[i];
    const std::vector<PreparedCase> cases = make_grid_cases(widest().lanes, c);
    std::vector<const PreparedCase*> pointers;
    pointers.reserve(cases.size());
    for (const PreparedCase& p : cases) pointers.push_back(&p);
    const SamplePlan plan = make_plan(with_history ? intervals[i] : 0.0);
    const long before = allocation_count;
    samples[i] = widest().run_lanes(pointers.data(), widest().lanes, options, plan).sample_count;
    counts[i] = allocation_count - before;
  }
  CAPTURE(with_history);
  CHECK(samples[0] == (with_history ? 71 : 0));
  CHECK(samples[1] == samples[0]);
  CHECK(counts[0] > 0);
  CHECK(counts[1] == counts[0]);
}

}  // namespace
}  // namespace strut
