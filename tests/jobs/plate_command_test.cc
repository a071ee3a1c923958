// strut identify RIG.toml: the record of a wheel plate, simulated by the program.

#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <utility>

#include "tests/jobs/parse_json.h"
#include "tests/jobs/run_program.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::run_program;

const std::string kRig = STRUT_SOURCE_DIR "/examples/rigs/wheel_plate.toml";
const std::string kSweep = STRUT_SOURCE_DIR "/examples/rigs/maneuvers/wheel_plate.toml";

std::string record(const test::TemporaryFolder& folder, const std::string& settings) {
  std::string file = folder / "plate.csv";
  REQUIRE(
      run_program("simulate " + kRig + " " + kSweep + settings + " --rate 1000 -o " + file).code ==
      0);
  return file;
}

TEST_CASE("identify gives a corner's parameters and its figures on a wheel plate", "[io]") {
  const test::TemporaryFolder folder;
  const std::string file = record(folder, " --set damping=800 --set tire_stiffness=220000");
  const test::Outcome outcome = run_program("identify " + kRig + " " + file + " --json");
  CAPTURE(outcome.messages);
  REQUIRE(outcome.code == 0);
  const auto json = test::parse_json(outcome.out);
  CHECK(json.get<double>("parameters.damping.value") == Approx(800.0).epsilon(2e-3));
  CHECK(json.get<double>("parameters.tire_stiffness.value") == Approx(220000.0).epsilon(2e-3));
  CHECK(json.get<double>("parameters.sprung_mass.value") == Approx(320.0).epsilon(2e-3));
  // c / (2 sqrt(k m)) of the values above.
  CHECK(json.get<double>("bench.lehr_damping.value") ==
        Approx(800.0 / (2.0 * std::sqrt(22000.0 * 320.0))).epsilon(3e-3));
  CHECK(json.get<double>("bench.lehr_damping_wheel.value") ==
        Approx(800.0 / (2.0 * std::sqrt(242000.0 * 40.0))).epsilon(3e-3));
  CHECK(json.get<double>("bench.static_load") == Approx(360.0 * 9.81).epsilon(2e-3));
  CHECK(json.get<double>("bench.eusama_percent.value") > 0.0);
  CHECK_FALSE(json.get<bool>("bench.at_wheel_mode"));
  const test::Outcome table = run_program("identify " + kRig + " " + file);
  CHECK_THAT(table.out, Contains("eusama_percent"));
  CHECK_THAT(table.out, Contains("phase_angle"));
}

TEST_CASE("identify refuses what is no record of a wheel plate", "[io]") {
  const test::TemporaryFolder folder;
  const std::string rows = "0,0,3500\n0.001,0,3500\n0.002,0,3500\n";
  const std::string still = folder.write("still.csv", "time,road_position,tire_force\n" + rows);
  const std::string other = folder.write("other.csv", "time,plate,force\n" + rows);
  const std::string command = "identify " + kRig + " ";
  const std::pair<std::string, std::string> cases[] = {
      {command, "must be one record"},
      {command + still, "cycles; must be at least 8"},
      {command + other, "no column 'road_position'"},
      {command + still + " --free damping", "--free: not for a wheel plate"},
      {command + still + " --set dampin=800", "damping"},
  };
  for (const auto& [line, message] : cases) {
    const test::Outcome outcome = run_program(line);
    CAPTURE(line);
    CHECK(outcome.code == 2);
    CHECK_THAT(outcome.messages, Contains(message));
  }
}

}  // namespace
}  // namespace strut
