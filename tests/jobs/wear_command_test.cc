// strut identify: wear in per cent of new, simulated by the program, identified by the program.

#include <catch2/catch.hpp>
#include <string>
#include <utility>

#include "tests/jobs/parse_json.h"
#include "tests/jobs/run_program.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::run_program;

const std::string kExamples = STRUT_SOURCE_DIR "/examples";
const std::string kVehicle = kExamples + "/vehicles/paper_sedan.toml";
const std::string kBump = kExamples + "/maneuvers/bump_20mps.toml";
const std::string kOneSided = kExamples + "/maneuvers/one_sided.toml";

std::string simulate(const test::TemporaryFolder& folder, const std::string& name,
                     const std::string& settings, const std::string& maneuver = kBump) {
  std::string file = folder / name;
  REQUIRE(run_program("simulate " + kVehicle + " " + maneuver + settings +
                      " --step 0.0005 --rate 200 -o " + file)
              .code == 0);
  return file;
}

std::string identify(const std::string& rest, const std::string& maneuver = kBump) {
  return "identify " + kVehicle + " " + rest + " --maneuver " + maneuver + " --window 0.3:2";
}

TEST_CASE("identify tells the wear of each axle and whether it is beyond a limit", "[io]") {
  const test::TemporaryFolder folder;
  // New: 1980 N s/m and 40000 N/m.
  const std::string file =
      simulate(folder, "worn.csv", " --set rear_damping=1386 --set front_stiffness=38000");
  const std::string options = file + " --limit 10 --limit rear_damping=25";
  const test::Outcome outcome = run_program(identify(options + " --json"));
  REQUIRE(outcome.code == 0);
  const auto rear = test::parse_json(outcome.out).get_child("parameters.rear_damping");
  CHECK(rear.get<double>("new") == 1980.0);
  CHECK(rear.get<double>("wear_percent") == Approx(30.0).margin(0.2));
  CHECK(rear.get<double>("limit_percent") == 25.0);
  CHECK(rear.get<double>("probability_beyond_limit") > 0.9);
  const auto front = test::parse_json(outcome.out).get_child("parameters.front_stiffness");
  CHECK(front.get<double>("wear_percent") == Approx(5.0).margin(0.2));
  CHECK(front.get<double>("limit_percent") == 10.0);
  CHECK(front.get<double>("probability_beyond_limit") < 0.1);
  const test::Outcome table = run_program(identify(options));
  CHECK_THAT(table.out, Contains("P(beyond)"));
}

TEST_CASE("A bump under one side tells the wear of each corner", "[io]") {
  const test::TemporaryFolder folder;
  const std::string file = simulate(folder, "worn.csv", " --set rear_left_damping=1386", kOneSided);
  const test::Outcome outcome = run_program(
      identify(file + " --by corner --limit 20 --json --channels imu_acceleration_z,imu_rate_x," +
                   "imu_rate_y",
               kOneSided));
  const auto json = test::parse_json(outcome.out).get_child("parameters");
  CHECK(json.size() == 8);
  CHECK(json.get<double>("rear_left_damping.wear_percent") == Approx(30.0).margin(1.0));
  CHECK(json.get<double>("rear_left_damping.probability_beyond_limit") > 0.9);
  CHECK(json.get<double>("front_left_damping.wear_percent") == Approx(0.0).margin(1.0));
}

TEST_CASE("The change since an earlier measurement has its own interval", "[io]") {
  const test::TemporaryFolder folder;
  const std::string before = simulate(folder, "before.csv", " --set rear_damping=1800");
  const std::string now = simulate(folder, "now.csv", " --set rear_damping=1485");
  const test::Outcome outcome = run_program(identify(now + " --before " + before + " --json"));
  REQUIRE(outcome.code == 0);
  const auto json = test::parse_json(outcome.out);
  const auto rear = json.get_child("parameters.rear_damping");
  CHECK(rear.get<double>("change_percent") ==
        Approx(100.0 * (1800.0 - 1485.0) / 1980.0).margin(0.2));
  const auto low = rear.get_child("change_ci95").front().second.get_value<double>();
  CHECK(low < rear.get<double>("change_percent"));
  CHECK(json.get<double>("before.parameters.rear_damping.value") == Approx(1800.0).epsilon(2e-3));
}

TEST_CASE("A load that is not known is freed as a nuisance, and the wear holds", "[io]") {
  const test::TemporaryFolder folder;
  const std::string file =
      simulate(folder, "loaded.csv", " --set body_payload_mass=75 --set rear_damping=1683");
  const auto read = [&](const std::string& options) {
    const test::Outcome outcome = run_program(identify(file + options + " --json"));
    const auto json = test::parse_json(outcome.out);
    return std::pair(json.get<double>("parameters.rear_damping.wear_percent"),
                     json.get_child("nuisances"));
  };
  const auto [ignored, few] = read("");
  const auto [freed, more] = read(" --nuisance body_payload_mass=0,75");
  CHECK(std::abs(freed - 15.0) < 0.3 * std::abs(ignored - 15.0));
  CHECK(more.size() == few.size() + 1);
}

TEST_CASE("identify refuses wrong questions about wear", "[io]") {
  const test::TemporaryFolder folder;
  const std::string good = folder.write("good.csv",
                                        "time,imu_acceleration_z,imu_rate_y\n0.5,9.8,0\n0.6,9.8,0\n"
                                        "0.7,9.8,0\n0.8,9.8,0\n0.9,9.8,0\n1.0,9.8,0\n");
  const std::pair<std::string, std::string> cases[] = {
      {" --by wheel", "--by = wheel: must be one of axle, corner"},
      {" --by axle --free rear_damping", "give it or --free, not both"},
      {" --nuisance rear_damping=1900,50", "is identified; --prior gives it a prior"},
      {" --nuisance payload=75,75", "payload"},
      {" --nuisance body_payload_mass=75", "NAME=MEAN,SIGMA"},
  };
  const auto check_refused = [](const std::string& file, const auto& questions) {
    for (const auto& [options, message] : questions) {
      const test::Outcome outcome = run_program(identify(file + options));
      CAPTURE(options);
      CHECK(outcome.code == 2);
      CHECK_THAT(outcome.messages, Contains(message));
    }
  };
  check_refused(good, cases);
  const std::pair<std::string, std::string> limits[] = {
      {" --limit 120", "--limit: 120: must be above 0 and below 100"},
      {" --limit rear_dampin=20", "did you mean 'rear_damping'"},
      {" --limit much", "must be PERCENT"},
      {" --free yaw_inertia --limit 20", "no identified parameter"},
  };
  check_refused(simulate(folder, "new.csv", ""), limits);
}

}  // namespace
}  // namespace strut
