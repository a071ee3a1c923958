// Every parameter as an axis of a sweep: its cases run side by side in the lanes of a batch.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "model_files/parameters.h"
#include "tests/support/test_car.h"

namespace strut {
namespace {

/// The shortest run in which every wheel has met the bump.
Case make_base() {
  Case c = test::make_paper_case();
  c.maneuver.duration = 0.35;
  c.maneuver.bump_distance = 2.0;
  return c;
}

/// Values of a parameter around that of the base, small enough that every car drives.
std::vector<double> list_values(const ParameterInfo& parameter, const Case& base, int count) {
  const double at = parameter.get(base);
  double reach = 0.02 * std::fabs(at);
  if (reach == 0.0) reach = parameter.typical > 0.0 ? 0.1 * parameter.typical : 1e-3;
  std::vector<double> values;
  for (int i = 0; i < count; ++i) {
    double value = at + reach * i / count;
    if (value > parameter.allowed.high) value = at - reach * i / count;
    values.push_back(value);
  }
  return values;
}

/// Cases that differ in a parameter alone.
std::vector<PreparedCase> prepare_axis(const ParameterInfo& parameter, int count) {
  std::vector<PreparedCase> cases;
  for (const double value : list_values(parameter, make_base(), count)) {
    Case c = make_base();
    if (parameter.name == "bump_spacing") c.maneuver.road.count = 2;
    parameter.set(c, value);
    cases.push_back(test::prepare(c));
  }
  return cases;
}

TEST_CASE("Cases along every parameter fill the lanes of a batch", "[unit][property]") {
  const Kernel& kernel = list_kernels().front();
  int axes = 0;
  for (const ParameterInfo& parameter : list_parameters()) {
    INFO(parameter.name);
    const std::vector<PreparedCase> cases = prepare_axis(parameter, kernel.lanes);
    for (const Closure closure : {Closure::kNewton, Closure::kTable}) {
      IntegrateOptions options;
      options.closure = closure;
      options.symmetry = true;
      const bool all_share = std::all_of(cases.begin(), cases.end(), [&](const PreparedCase& c) {
        return may_share_lanes(cases.front(), c, options);
      });
      // What is one-sided makes whole cars of all but the base, which alone is a half.
      const bool is_one_sided = is_symmetric(cases.front()) && !is_symmetric(cases.back());
      CHECK((all_share || is_one_sided));
      if (is_one_sided) {
        options.symmetry = false;
        CHECK(std::all_of(cases.begin(), cases.end(), [&](const PreparedCase& c) {
          return may_share_lanes(cases.front(), c, options);
        }));
      }
    }
    ++axes;
  }
  CHECK(axes > 100);
}

TEST_CASE("A batch along every parameter does the work of one run a lane", "[slow][property]") {
  const Kernel& kernel = list_kernels().front();
  IntegrateOptions options;
  options.step.step = 1e-3;
  options.closure = Closure::kTable;
  for (const ParameterInfo& parameter : list_parameters()) {
    INFO(parameter.name);
    const std::vector<PreparedCase> cases = prepare_axis(parameter, kernel.lanes);
    std::vector<const PreparedCase*> pointers;
    long alone = 0;
    for (const PreparedCase& c : cases) {
      pointers.push_back(&c);
      alone += kernel.run_scalar(c, options, {}).derivative_count;
    }
    const LaneResults together = kernel.run_lanes(pointers.data(), kernel.lanes, options, {});
    // A right-hand side of eight lanes takes 1.25 times that of one (docs/performance.md), so that
    // a batch is at least five times as fast as its runs one by one.
    CHECK(static_cast<double>(kernel.lanes * together.derivative_count) <
          1.28 * static_cast<double>(alone));
  }
}

}  // namespace
}  // namespace strut
