// Wear in per cent of new, against figures worked out by hand and tables of the normal
// distribution.
#include "identify/wear.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "base/error/input_error.h"
#include "tests/support/test_car.h"
#include "tests/support/tolerance.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::tolerance;
using Names = std::vector<std::string>;

IdentifiedRow make_row(double value, double half_width) {
  IdentifiedRow row;
  row.parameters = {{"rear_damping", "N s/m", value, half_width, true}};
  return row;
}

std::vector<WearScale> make_scales(double limit) {
  std::vector<WearScale> scales = {{"rear_damping", 2000.0}};
  set_wear_limit(scales, "", limit);
  return scales;
}

Wear measure(double value, double half_width, double limit) {
  IdentifiedRow row = make_row(value, half_width);
  add_wear(row, make_scales(limit));
  return row.parameters.front().wear.value();
}

TEST_CASE("Wear is the loss in per cent of new, with its interval", "[unit]") {
  const Wear wear = measure(1500.0, 40.0, 30.0);
  CHECK(wear.percent == Approx(25.0));
  CHECK(wear.half_width == Approx(2.0));
  CHECK(measure(2100.0, 40.0, 30.0).percent == Approx(-5.0));  // stiffer than new
}

TEST_CASE("The probability of wear beyond a limit is that of the normal distribution", "[unit]") {
  // The standard error is 1 point: half width 1.96 points of 2000 N s/m.
  const double half_width = 0.01 * 1.959964 * 2000.0;
  const auto calc = [&](double above) {
    return measure(2000.0 * (1.0 - 0.01 * (30.0 + above)), half_width, 30.0).beyond;
  };
  CHECK(calc(0.0) == Approx(0.5));
  CHECK(calc(1.0) == Approx(0.8413447).epsilon(tolerance(1e-6)));
  CHECK(calc(-1.0) == Approx(0.1586553).epsilon(tolerance(1e-6)));
  CHECK(calc(1.644854) == Approx(0.95).epsilon(tolerance(1e-6)));
  CHECK(calc(8.0) == Approx(1.0 - kLeastBeyond));  // its tails are not known so far
  CHECK(calc(-8.0) == Approx(kLeastBeyond));
}

TEST_CASE("The wear of a fit takes the interval that its residuals widen", "[unit]") {
  IdentifiedRow row = make_row(1500.0, 40.0);
  row.parameters.front().widened_half_width = 120.0;
  add_wear(row, make_scales(30.0));
  CHECK(row.parameters.front().wear.value().half_width == Approx(6.0));
}

TEST_CASE("Where a parameter is unknown, so is its wear", "[unit]") {
  IdentifiedRow row = make_row(1500.0, 40.0);
  row.parameters.front().in_range = false;
  add_wear(row, make_scales(30.0));
  const Wear wear = row.parameters.front().wear.value();
  CHECK(std::isnan(wear.half_width));
  CHECK(std::isnan(wear.beyond));
  const Wear open = measure(1500.0, std::numeric_limits<double>::infinity(), 30.0);
  CHECK(std::isnan(open.beyond));
}

TEST_CASE("A change of wear is the difference of two, with independent errors", "[unit]") {
  IdentifiedRow now = make_row(1400.0, 60.0), before = make_row(1800.0, 80.0);
  add_wear(now, make_scales(30.0));
  add_wear(before, make_scales(30.0));
  add_wear_change(now, before);
  const WearChange change = now.parameters.front().change.value();
  CHECK(change.percent == Approx(20.0));
  CHECK(change.half_width == Approx(5.0));  // sqrt(3^2 + 4^2)
}

TEST_CASE("Springs and dampers wear, by axle or by corner", "[unit]") {
  CHECK(list_wear_parameters(WearLocations::kByAxle) ==
        Names{"front_stiffness", "front_damping", "rear_stiffness", "rear_damping"});
  CHECK(list_wear_parameters(WearLocations::kByCorner).size() == 8);
  const Case fresh = test::make_paper_case();
  const std::vector<WearScale> scales =
      make_wear_scales(fresh, {"rear_damping", "sprung_mass", "rear_right_stiffness"});
  REQUIRE(scales.size() == 2);
  CHECK(scales[0].fresh == fresh.vehicle.suspension[1].strut[0].damping);
  CHECK(scales[1].fresh == fresh.vehicle.suspension[1].strut[1].stiffness);
}

TEST_CASE("A limit holds for one part or for all, and others are refused", "[unit]") {
  std::vector<WearScale> scales = {{"front_damping", 2000.0}, {"rear_damping", 2000.0}};
  set_wear_limit(scales, "", 20.0);
  set_wear_limit(scales, "rear_damping", 30.0);
  CHECK(scales[0].limit == 20.0);
  CHECK(scales[1].limit == 30.0);
  CHECK_THROWS_WITH(set_wear_limit(scales, "rear_dampin", 20.0), Contains("rear_damping"));
  CHECK_THROWS_WITH(set_wear_limit(scales, "", 100.0), Contains("below 100 %"));
  CHECK_THROWS_WITH(set_wear_limit(scales, "", std::nan("")), Contains("above 0"));
  std::vector<WearScale> none;
  CHECK_THROWS_WITH(set_wear_limit(none, "", 20.0), Contains("no identified parameter"));
}

}  // namespace
}  // namespace strut
