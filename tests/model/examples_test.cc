// Every car and maneuver that ships as an example, and the options of the paper's car: whole runs
// against CVODE, lanes against double, loads and tables, the numbers of the paper's run.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "model/kernel/simulation.h"
#include "model_files/read_maneuver.h"
#include "model_files/read_vehicle.h"
#include "tests/model/test_corner.h"
#include "tests/support/test_run.h"

namespace strut {
namespace {

using C = CarChannel;
using test::make_plan;
using test::tolerance;

const std::string kExamples = STRUT_SOURCE_DIR "/examples/";
const char* const kCars[] = {"paper_sedan", "compact_hatch", "generic_wide"};
const char* const kManeuvers[] = {"bump_20mps", "one_sided", "measured_profile"};

VehicleSpec read_car(const std::string& name) {
  return read_vehicle(kExamples + "vehicles/" + name + ".toml");
}

/// An example, cut to the crossing of its bump so that the test stays fast.
Case make_short_case(const std::string& car, const std::string& maneuver) {
  Case c{read_car(car), read_maneuver(kExamples + "maneuvers/" + maneuver + ".toml")};
  c.maneuver.bump_distance = 3.0;
  c.maneuver.duration = c.maneuver.speed > 15.0 ? 0.6 : 0.9;
  return c;
}

IntegrateOptions make_options(double step, Closure closure = Closure::kTable) {
  IntegrateOptions options;
  options.step.step = step;
  options.closure = closure;
  return options;
}

LaneResults run_table_cvode(const PreparedCase& c, const SamplePlan& plan) {
  ReferenceOptions options;
  options.closure = Closure::kTable;
  return run_cvode(c, options, plan);
}

/// Largest difference of a channel over the history.
double calc_difference(const LaneResults& a, const LaneResults& b, int channel, int lane_a = 0) {
  REQUIRE(a.sample_count == b.sample_count);
  double largest = 0.0;
  for (int i = 0; i < a.sample_count; ++i) {
    largest =
        std::max(largest, std::abs(a.get_sample(i, channel, lane_a) - b.get_sample(i, channel)));
  }
  return largest;
}

/// Height [m] and pitch [rad] of a run at 0.25 ms against CVODE's.
void check_against_cvode(const Case& c) {
  const PreparedCase prepared = test::prepare(c);
  const SamplePlan plan = make_plan(0.01);
  const LaneResults truth = run_table_cvode(prepared, plan);
  const LaneResults run = list_kernels().back().run_scalar(prepared, make_options(2.5e-4), plan);
  REQUIRE(run.status[0] == static_cast<int>(RunStatus::kDone));
  REQUIRE(truth.status[0] == static_cast<int>(RunStatus::kDone));
  const double height = calc_difference(run, truth, C::kBodyPositionZ);
  const double pitch = calc_difference(run, truth, C::kPitchAngle);
  double rise = 0.0;
  for (int i = 0; i < truth.sample_count; ++i) {
    rise = std::max(rise, std::abs(truth.get_sample(i, C::kBodyPositionZ) -
                                   truth.get_sample(0, C::kBodyPositionZ)));
  }
  INFO("height " << std::scientific << height << " m, pitch " << pitch << " rad, rise " << rise
                 << " m");
  CHECK(rise > 1e-3);  // the bump is felt
  // 1e-9 of the integrator's; up to 8e-7 where tires lift off and touch, or where the slope of the
  // road jumps.
  CHECK(height < tolerance(1e-6));
  CHECK(pitch < tolerance(1e-6));
}

TEST_CASE("Every example car crosses every example bump as CVODE has it", "[unit][reference]") {
  for (const char* car : kCars) {
    for (const char* maneuver : kManeuvers) {
      DYNAMIC_SECTION(car << " over " << maneuver) {
        check_against_cvode(make_short_case(car, maneuver));
      }
    }
  }
}

TEST_CASE("Every example car keeps its loops closed over every example bump", "[unit][property]") {
  for (const char* car : kCars) {
    for (const char* maneuver : kManeuvers) {
      CAPTURE(car, maneuver);
      const PreparedCase c = test::prepare(make_short_case(car, maneuver));
      const LaneResults run =
          list_kernels().back().run_scalar(c, make_options(1e-3, Closure::kNewton), {});
      CHECK(run.status[0] == static_cast<int>(RunStatus::kDone));
      INFO("largest loop error " << std::scientific << run.loop_error[0] << " m");
      CHECK(run.loop_error[0] < tolerance(1e-10));
    }
  }
}

/// The paper's car with one of its options.
Case make_variant(const std::string& name) {
  Case c = make_short_case("paper_sedan", "bump_20mps");
  if (name == "relaxation") c.vehicle.tire.relaxation = true;
  if (name == "static trim") c.maneuver.trim = TrimKind::kStatic;
  if (name == "point contact") c.vehicle.tire.contact = ContactKind::kPoint;
  if (name == "bare disc") c.vehicle.tire.footprint = 0.0;
  return c;
}

TEST_CASE("The options of the paper's car run as CVODE has them", "[unit][reference]") {
  for (const char* name : {"relaxation", "static trim", "point contact", "bare disc"}) {
    DYNAMIC_SECTION(name) { check_against_cvode(make_variant(name)); }
  }
}

TEST_CASE("Kinks of the road at different times in lanes leave each lane as it is alone",
          "[unit][property]") {
  const Kernel& kernel = list_kernels().front();
  const SamplePlan plan = make_plan(0.01);
  const IntegrateOptions options = make_options(1e-3);
  for (const char* name : {"point contact", "bare disc"}) {
    CasePreparer preparer;
    std::vector<PreparedCase> cases;
    cases.reserve(static_cast<std::size_t>(kernel.lanes));
    for (int lane = 0; lane < kernel.lanes; ++lane) {
      Case c = make_variant(name);
      c.maneuver.speed += 0.37 * lane;
      cases.push_back(preparer.prepare(c));
    }
    std::vector<const PreparedCase*> pointers;
    pointers.reserve(cases.size());
    for (const PreparedCase& c : cases) pointers.push_back(&c);
    const LaneResults lanes = kernel.run_lanes(pointers.data(), kernel.lanes, options, plan);
    for (int lane = 0; lane < kernel.lanes; ++lane) {
      const auto at = static_cast<std::size_t>(lane);
      const LaneResults alone = list_kernels().back().run_scalar(cases[at], options, plan);
      CAPTURE(name, lane, lanes.event_count, alone.event_count);
      CHECK(lanes.status[at] == static_cast<int>(RunStatus::kDone));
      CHECK(calc_difference(lanes, alone, C::kBodyPositionZ, lane) < tolerance(1e-9));
      CHECK(calc_difference(lanes, alone, C::kPitchAngle, lane) < tolerance(1e-9));
    }
  }
}

TEST_CASE("Every example car stands on its tires by the lever rule", "[unit]") {
  for (const char* car : kCars) {
    Case c{read_car(car), {}};
    c.maneuver.road.shape = BumpShape::kNone;
    const WholeCarSpec& whole = c.vehicle.whole;
    const auto load = test::rest(test::prepare(c)).load;
    for (int corner = 0; corner < kCorners; ++corner) {
      const double lever =
          axle_of(corner) == kFront ? whole.centroid_to_rear : whole.centroid_to_front;
      const double expected = 0.5 * whole.mass * c.maneuver.gravity * lever /
                              (whole.centroid_to_front + whole.centroid_to_rear);
      const double error = load[corner] / expected - 1.0;
      INFO(car << ", corner " << corner << ": " << std::scientific << error << " of " << expected
               << " N");
      CHECK(std::abs(error) < tolerance(1e-6));
    }
  }
}

/// Largest difference of the values of a corner's motion functions between table and Newton's
/// closure, relative to the function's largest size or 1 (m, kg m, ...).
double compare_closures(const AssembledVehicle& car, const VehicleTables<double>& tables,
                        int corner) {
  const TableClosure<double, double> table{&tables};
  const auto collect = [](const test::Motion& m) {
    std::vector<double> list;
    for (const auto& v : {m.moment, m.coupling, m.center, m.axis}) test::append(list, v);
    test::append(list, m.inertia);
    list.insert(list.end(), {m.mass, m.length[0], m.length[1]});
    return list;
  };
  std::vector<double> largest, difference;
  for (const double q : test::make_travels(201)) {
    test::Motion tabulated{};
    table(corner, q, tabulated);
    const auto a = collect(tabulated), b = collect(test::calc_motion(car, corner, q));
    largest.resize(a.size(), 1.0);
    difference.resize(a.size(), 0.0);
    for (std::size_t i = 0; i < a.size(); ++i) {
      largest[i] = std::max(largest[i], std::abs(b[i]));
      difference[i] = std::max(difference[i], std::abs(a[i] - b[i]));
    }
  }
  double worst = 0.0;
  for (std::size_t i = 0; i < largest.size(); ++i) {
    worst = std::max(worst, difference[i] / largest[i]);
  }
  return worst;
}

TEST_CASE("Tables of every example car equal Newton's closure", "[unit][property]") {
  for (const char* name : kCars) {
    const AssembledVehicle car = test::make_car(read_car(name));
    const VehicleTables<double> tables = tabulate_corners(car);
    for (int corner = 0; corner < kCorners; ++corner) {
      const double worst = compare_closures(car, tables, corner);
      INFO(name << ", corner " << corner << ": " << std::scientific << worst);
      // A few coefficients just below the 1e-11 at which the series are cut, of either sign.
      CHECK(worst < tolerance(8e-12));
    }
  }
}

}  // namespace
}  // namespace strut
