// `strut list` as a user meets it: every table, as text and JSON, of kinds and files; what it
// refuses.
#include <catch2/catch.hpp>
#include <set>

#include "jobs/commands.h"
#include "model/car/car_info.h"
#include "model/effects/catalogue.h"
#include "model_files/parameters.h"
#include "tests/jobs/parse_json.h"
#include "tests/jobs/run_program.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::Outcome;
using test::run_program;

const std::string kExamples = STRUT_SOURCE_DIR "/examples/";

test::JsonTree list(const std::string& words) {
  const Outcome outcome = run_program("list " + words + " --json");
  INFO(outcome.messages);
  REQUIRE(outcome.code == 0);
  return test::parse_json(outcome.out);
}

std::set<std::string> get_names(const test::JsonTree& rows) {
  std::set<std::string> names;
  for (const auto& [key, row] : rows) names.insert(row.get<std::string>("name"));
  return names;
}

TEST_CASE("list tells every parameter of a car with unit, default, range and source", "[io]") {
  const auto rows = list("parameters");
  REQUIRE(rows.size() == list_parameters().size());
  auto parameter = list_parameters().begin();
  for (const auto& [key, row] : rows) {
    INFO(parameter->name);
    CHECK(row.get<std::string>("name") == parameter->name);
    CHECK(row.get<std::string>("unit") == parameter->unit);
    CHECK(row.get<double>("default") == *parameter->default_value);
    CHECK(row.get_child("range").front().second.get_value<double>() == parameter->allowed.low);
    CHECK(row.get<bool>("effect") == parameter->is_effect);
    CHECK_FALSE(row.get<std::string>("source").empty());
    CHECK_FALSE(row.get<std::string>("meaning").empty());
    ++parameter;
  }
  const Outcome text = run_program("list parameters");
  CHECK(text.code == 0);
  CHECK_THAT(text.out,
             Contains("NAME") && Contains("\nfront_stiffness ") && Contains("[100, 1e+06]"));
}

TEST_CASE("list shows the values that a vehicle's or rig's file has", "[io]") {
  const auto find = [](const test::JsonTree& rows, const std::string& name) {
    for (const auto& [key, row] : rows) {
      if (row.get<std::string>("name") == name) return row;
    }
    FAIL("no row " << name);
    return test::JsonTree();
  };
  const auto car = list("parameters " + kExamples + "vehicles/paper_sedan.toml");
  CHECK(find(car, "mass").get<double>("value") == 1155.0);
  CHECK(find(car, "speed").get<std::string>("value") == "null");  // the maneuver's
  const auto rig = list("parameters " + kExamples + "rigs/quarter_car.toml");
  CHECK(find(rig, "stiffness").get<std::string>("default") == "null");
  CHECK(find(rig, "stiffness").get<double>("value") == 900.0);
  CHECK_THAT(run_program("list parameters " + kExamples + "rigs/quarter_car.toml").out,
             Contains("DEFAULT") && Contains("VALUE"));
}

TEST_CASE("list tells channels, inputs and effects by the kind of model", "[io]") {
  CHECK(get_names(list("channels")).count("front_left_wheel_acceleration_z") == 1);
  const auto quarter = list("channels quarter_car");
  CHECK(get_names(quarter).count("sprung_acceleration") == 1);
  CHECK(get_names(quarter).count("pitch_rate") == 0);
  std::size_t inputs = 0;
  for (const auto& [key, row] : quarter) inputs += row.get<std::string>("role") == "input" ? 1 : 0;
  CHECK(inputs == 2);
  const auto of_car = get_names(list("effects"));
  for (const EffectInfo& effect : list_effects()) {
    const bool listed = of_car.count(effect.name) == 1;
    CHECK(listed == !list_effect_places(effect, get_car_info()).empty());
  }
  const auto mass = get_names(list("effects single_mass"));
  CHECK(mass.count("strut_friction") == 1);
  CHECK(mass.count("aerodynamic_lift") == 0);
  CHECK(list("commands").size() == list_commands().size());
  CHECK_THAT(run_program("list effects").out, Contains("damper_blow_off") && Contains("source: "));
  CHECK_THAT(run_program("list commands").out, Contains("list") && Contains("diagnose"));
}

TEST_CASE("list refuses what it cannot list and says what it can", "[io]") {
  const auto check = [](const std::string& words, const std::string& says) {
    const Outcome outcome = run_program("list " + words);
    INFO(words << ": " << outcome.messages);
    CHECK(outcome.code == 2);
    CHECK(outcome.out.empty());
    CHECK_THAT(outcome.messages, Contains(says));
  };
  check("", "parameters, channels, effects, commands");
  check("parameter", "parameters, channels, effects, commands");
  check("parameters quarter_car more", "at most one model");
  check("commands quarter_car", "takes no model");
  check("parameters quartr_car", "quarter_car");
  check("parameters " + kExamples + "sweeps/paper.toml", "paper.toml");
  check("parameters " + kExamples, "examples");
}

}  // namespace
}  // namespace strut
