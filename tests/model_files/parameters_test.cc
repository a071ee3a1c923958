#include "model_files/parameters.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <set>

#include "model_files/read_maneuver.h"
#include "model_files/read_vehicle.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;

Case read_paper_case() {
  const std::filesystem::path examples = std::filesystem::path(STRUT_SOURCE_DIR) / "examples";
  Case c;
  c.vehicle = read_vehicle(examples / "vehicles/paper_sedan.toml");
  c.maneuver = read_maneuver(examples / "maneuvers/bump_20mps.toml");
  return c;
}

// A value within the range that differs from the default by an ordinary amount.
double choose_other_value(const ParameterInfo& parameter) {
  const Range& r = parameter.allowed;
  const double inside = *parameter.default_value + 0.01 * (r.high - r.low);
  return inside <= r.high ? inside : *parameter.default_value - 0.01 * (r.high - r.low);
}

TEST_CASE("The default of every parameter is what the paper's files say", "[io]") {
  const Case paper = read_paper_case();
  for (const ParameterInfo& parameter : list_parameters()) {
    INFO(parameter.name);
    // A trapezoid's ramp is no part of the paper's arc.
    if (parameter.name == "bump_ramp") continue;
    CHECK(parameter.get(paper) == parameter.default_value);
  }
}

TEST_CASE("Every parameter has one name, a unit, a range around its default and a source",
          "[unit]") {
  std::set<std::string> names;
  for (const ParameterInfo& parameter : list_parameters()) {
    INFO(parameter.name);
    CHECK(names.insert(parameter.name).second);
    CHECK_FALSE(parameter.unit.empty());
    CHECK_FALSE(parameter.description.empty());
    CHECK_FALSE(parameter.source.empty());
    CHECK(parameter.allowed.contains(*parameter.default_value));
    CHECK(std::isfinite(parameter.allowed.low));
    CHECK(std::isfinite(parameter.allowed.high));
  }
}

TEST_CASE("A parameter that is set reads back and moves nothing it does not contain",
          "[unit][property]") {
  const Case paper = read_paper_case();
  std::set<std::string> names;
  for (const ParameterInfo& parameter : list_parameters()) names.insert(parameter.name);
  // Parameters of both an axle and its corners.
  const auto is_of = [&](const std::string& name, const std::string& axle,
                         const std::string& place) {
    if (!name.starts_with(place)) return false;
    const std::string what = name.substr(place.size());
    return names.count(axle + "left_" + what) == 1 && names.count(axle + what) == 1;
  };
  for (const ParameterInfo& parameter : list_parameters()) {
    const double value = choose_other_value(parameter);
    Case changed = paper;
    changed.maneuver.road.count = 2;  // of which bump_spacing is the distance
    set_parameter(changed, parameter.name, value);
    INFO(parameter.name);
    CHECK(get_parameter(changed, parameter.name) == value);
    int moved = 0;
    for (const ParameterInfo& other : list_parameters()) {
      moved += other.get(changed) != other.get(paper) ? 1 : 0;
    }
    const std::string& name = parameter.name;
    bool axle = false, corner = false;
    for (const std::string of : {"front_", "rear_"}) {
      axle = axle || is_of(name, of, of);
      corner = corner || is_of(name, of, of + "left_") || is_of(name, of, of + "right_");
    }
    // An axle's rate moves its two corners' as well, a corner's rate the axle's mean.
    CHECK(moved == (axle ? 3 : corner ? 2 : 1));
    set_parameter(changed, parameter.name, parameter.get(paper));
    CHECK(parameter.get(changed) == parameter.get(paper));
  }
}

TEST_CASE("An axle's parameter is the mean of its corners and sets both", "[unit]") {
  Case c = read_paper_case();
  apply_setting(c, "front_left_stiffness=30000");
  CHECK(c.vehicle.suspension[kFront].strut[0].stiffness == 30000.0);
  CHECK(c.vehicle.suspension[kFront].strut[1].stiffness == 40000.0);
  CHECK(get_parameter(c, "front_stiffness") == 35000.0);
  apply_setting(c, "front_stiffness=38000");
  CHECK(get_parameter(c, "front_left_stiffness") == 38000.0);
  CHECK(get_parameter(c, "front_right_stiffness") == 38000.0);
  CHECK(get_parameter(c, "rear_stiffness") == 35000.0);
}

TEST_CASE("A worn spring keeps its nominal rate", "[unit]") {
  Case c = read_paper_case();
  apply_setting(c, "rear_stiffness=30500");
  CHECK(c.vehicle.suspension[kRear].strut[0].nominal_stiffness == 35000.0);
}

TEST_CASE("Drive shares always add up to one", "[unit]") {
  Case c = read_paper_case();
  apply_setting(c, "front_drive_share=0.25");
  CHECK(c.vehicle.suspension[kFront].drive_share == 0.25);
  CHECK(c.vehicle.suspension[kRear].drive_share == 0.75);
}

TEST_CASE("A setting may have a unit", "[unit]") {
  Case c = read_paper_case();
  apply_setting(c, "speed=36km/h");
  CHECK(c.maneuver.speed == Approx(10.0).epsilon(1e-15));
  apply_setting(c, "front_stiffness=38 N/mm");
  CHECK(get_parameter(c, "front_stiffness") == 38000.0);
  apply_setting(c, "rear_damping=1.9 kN s/m");
  CHECK(get_parameter(c, "rear_damping") == Approx(1900.0).epsilon(1e-15));
  apply_setting(c, "bump_height=30mm");
  CHECK(c.maneuver.road.height == Approx(0.03).epsilon(1e-15));
  CHECK_THROWS_WITH(apply_setting(c, "speed=36 mm"),
                    Contains("speed = 36 mm: unit \"mm\": unknown for a quantity in m/s"));
  CHECK_THROWS_WITH(apply_setting(c, "mass=5 stones"), Contains("allowed: kg"));
}

TEST_CASE("A bad setting says what is allowed", "[unit]") {
  Case c = read_paper_case();
  const Case before = c;
  CHECK_THROWS_WITH(
      apply_setting(c, "front_stifness=1"),
      Contains("unknown parameter 'front_stifness'; did you mean 'front_stiffness'?"));
  CHECK_THROWS_WITH(apply_setting(c, "mass=-5"), "mass = -5: must lie in [200, 20000] kg");
  CHECK_THROWS_WITH(apply_setting(c, "mass=heavy"), Contains("mass = 'heavy': must be a number"));
  for (const char* setting : {"mass", "mass=", "=5", "mass=1155 kg m", "mass=nan", "speed=inf",
                              "mass= 1155", "x_y_z_q=1"}) {
    INFO(setting);
    CHECK_THROWS_AS(apply_setting(c, setting), InputError);
  }
  CHECK(c.vehicle == before.vehicle);
}

TEST_CASE("A tabulated bump has no height to set", "[unit]") {
  Case c = read_paper_case();
  c.maneuver.road.shape = BumpShape::kTable;
  CHECK_THROWS_WITH(apply_setting(c, "bump_height=0.06"), Contains("table"));
  c.maneuver.road.shape = BumpShape::kCosine;
  CHECK_NOTHROW(apply_setting(c, "bump_height=0.06"));
  CHECK(c.maneuver.road.height == 0.06);
}

}  // namespace
}  // namespace strut
