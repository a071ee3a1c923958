// Fitted parameters in a model's file.
#include "model_files/read_fitted.h"

#include <catch2/catch.hpp>
#include <string>

#include "base/error/input_error.h"
#include "io/file/read_text_file.h"
#include "model_files/parameters.h"
#include "model_files/read_rig.h"
#include "model_files/read_vehicle.h"
#include "tests/support/temporary_folder.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;

const std::string kExamples = std::string(STRUT_SOURCE_DIR) + "/examples/";

TEST_CASE("Fitted parameters replace those of a rig's file", "[unit]") {
  const std::string text = read_text_file(kExamples + "rigs/quarter_car.toml");
  const test::TemporaryFolder folder;
  const std::string first = replace_fitted(text, {{"stiffness", 812.5}, {"damping", 9.25}});
  folder.write("rig.toml", first);
  const RigSpec rig = read_rig(folder / "rig.toml");
  CHECK(rig.stiffness == 812.5);
  CHECK(rig.damping == 9.25);
  CHECK(rig.sprung_mass == read_rig(kExamples + "rigs/quarter_car.toml").sprung_mass);
  // Replaced, not added; and nothing else changes.
  CHECK(replace_fitted(replace_fitted(first, {{"damping", 1.0}}), {}) == replace_fitted(text, {}));
}

TEST_CASE("Fitted parameters replace those of a car's file", "[unit]") {
  std::string text = read_text_file(kExamples + "vehicles/paper_sedan.toml");
  const std::string tire = "\"../tires/paper_sedan.tir\"";
  REQUIRE(text.find(tire) != std::string::npos);
  text.replace(text.find(tire), tire.size(), "\"" + kExamples + "tires/paper_sedan.tir\"");
  const test::TemporaryFolder folder;
  folder.write("car.toml", replace_fitted(text, {{"front_stiffness", 37123.5}}));
  const VehicleSpec car = read_vehicle(folder / "car.toml");
  CHECK(get_parameter(Case{car, {}}, "front_stiffness") == 37123.5);
}

TEST_CASE("A fitted parameter that is none of the model's own is refused", "[unit]") {
  const std::string text = read_text_file(kExamples + "rigs/quarter_car.toml");
  const test::TemporaryFolder folder;
  for (const auto& [line, told] : std::vector<std::pair<std::string, std::string>>{
           {"stifness = 900", "stiffness"},
           {"strut_friction_force = 1", "not a parameter of the rig itself"},
           {"stiffness = -1", "stiffness"}}) {
    folder.write("rig.toml", text + "\n[fitted]\n" + line + "\n");
    CHECK_THROWS_WITH(read_rig(folder / "rig.toml"), Contains(told));
  }
}

}  // namespace
}  // namespace strut
