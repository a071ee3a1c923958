// Effects through the program: a file that names them and a setting are one and the same.

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "model/model.h"
#include "model_files/read_effects.h"
#include "tests/jobs/run_program.h"
#include "tests/support/temporary_folder.h"

namespace strut {
namespace {

namespace fs = std::filesystem;
const fs::path kExamples = fs::path(STRUT_SOURCE_DIR) / "examples";

/// The car's file with one effect, where its tire is found.
std::string write_car(const test::TemporaryFolder& folder, const EffectSettings& effects) {
  fs::copy(kExamples / "tires", folder / "tires", fs::copy_options::recursive);
  fs::create_directory(folder / "vehicles");
  const std::string plain = test::read_text(kExamples / "vehicles/paper_sedan.toml");
  return folder.write("vehicles/extended.toml", replace_effects(plain, effects, get_car_info()));
}

TEST_CASE("A car's effect from its file and by a setting give one run", "[io][effects]") {
  const test::TemporaryFolder folder;
  const std::string car = write_car(folder, {{"damper_asymmetry", "rear", {0.3}}});
  const std::string maneuver = kExamples / "maneuvers/bump_20mps.toml";
  const auto simulate = [&](const std::string& vehicle, const std::string& more) {
    const std::string file = folder / "run.csv";
    const test::Outcome outcome = test::run_program("simulate " + vehicle + " " + maneuver +
                                                    " --force -o " + file + " --rate 50 " + more);
    INFO(outcome.messages);
    REQUIRE(outcome.code == 0);
    return test::read_text(file);
  };
  const std::string plain = kExamples / "vehicles/paper_sedan.toml";
  const std::string from_file = simulate(car, "");
  CHECK(from_file == simulate(plain, "--set rear_damper_asymmetry=0.3"));
  CHECK(from_file != simulate(plain, ""));
  CHECK(simulate(car, "--set rear_damper_asymmetry=0") == simulate(plain, ""));
}

TEST_CASE("A rig's effect from its file and by a setting give one run", "[io][effects]") {
  const test::TemporaryFolder folder;
  const std::string plain = kExamples / "rigs/quarter_car.toml";
  const std::string extended =
      folder.write("rig.toml", replace_effects(test::read_text(plain),
                                               {{"strut_friction", "", {1.0, 0.01, 0.0}}},
                                               get_rig_info(RigKind::kQuarterCar)));
  const std::string maneuver = kExamples / "rigs/maneuvers/bump.toml";
  const auto simulate = [&](const std::string& rig, const std::string& more) {
    const std::string file = folder / "run.csv";
    const test::Outcome outcome = test::run_program("simulate " + rig + " " + maneuver +
                                                    " --force -o " + file + " --rate 100 " + more);
    INFO(outcome.messages);
    REQUIRE(outcome.code == 0);
    return test::read_text(file);
  };
  const std::string from_file = simulate(extended, "");
  CHECK(from_file == simulate(plain, "--set strut_friction_force=1"));
  CHECK(from_file != simulate(plain, ""));
}

TEST_CASE("A strut that loses stroke is simulated in steps that resolve the stroke",
          "[io][effects]") {
  const test::TemporaryFolder folder;
  const auto simulate = [&](const std::string& rig, const std::string& more) {
    return test::run_program("simulate " + (kExamples / "rigs" / rig).string() + " " +
                             (kExamples / "rigs/maneuvers/dynamometer.toml").string() +
                             " --force --rate 100 -o " + (folder / "run.csv").string() + more);
  };
  const std::string stroke = " --set damper_leak=1e-4";
  const test::Outcome automatic = simulate("damper_dyno.toml", stroke);
  REQUIRE(automatic.code == 0);
  CHECK(automatic.messages.find("warning") == std::string::npos);
  const std::string resolved = test::read_text(folder / "run.csv");
  const test::Outcome coarse = simulate("damper_dyno.toml", stroke + " --step 1e-3");
  REQUIRE(coarse.code == 0);
  CHECK(coarse.messages.find("--step = 0.001 s: too long to resolve the effects") !=
        std::string::npos);
  CHECK(test::read_text(folder / "run.csv") != resolved);
  // Contact time 0.196 ms: halving 1 ms ends at an eighth.
  CHECK(simulate("damper_dyno.toml", stroke + " --step 1.25e-4").messages.find("warning") ==
        std::string::npos);
  CHECK(test::read_text(folder / "run.csv") == resolved);
  CHECK(simulate("damper_dyno.toml", " --step 1e-3").messages.find("warning") == std::string::npos);
}

/// Columns of a CSV file by name.
std::map<std::string, std::vector<double>> read_columns(const std::string& path) {
  std::ifstream file(path);
  std::string line, cell;
  std::vector<std::string> names;
  std::map<std::string, std::vector<double>> columns;
  std::getline(file, line);
  for (std::istringstream cells(line); std::getline(cells, cell, ',');) {
    names.push_back(cell.substr(0, cell.find_first_of(" [")));
  }
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    for (std::size_t i = 0; std::getline(cells, cell, ','); ++i) {
      if (line[0] != '#') columns[names.at(i)].push_back(std::strtod(cell.c_str(), nullptr));
    }
  }
  return columns;
}

TEST_CASE("What sensors read is what simulate writes, of cars and rigs", "[io][effects]") {
  const test::TemporaryFolder folder;
  const bool car = GENERATE(true, false);
  const std::string model =
      kExamples / (car ? "vehicles/paper_sedan.toml" : "rigs/quarter_car.toml");
  const std::string maneuver =
      kExamples / (car ? "maneuvers/bump_20mps.toml" : "rigs/maneuvers/bump.toml");
  const std::string loud = car ? "pitch_rate" : "sprung_position";
  const std::string late = car ? "body_velocity_z" : "sprung_velocity";
  const auto simulate = [&](const std::string& more) {
    const std::string file = folder / "run.csv";
    const test::Outcome outcome = test::run_program("simulate " + model + " " + maneuver +
                                                    " --force -o " + file + " " + more);
    INFO(outcome.messages);
    REQUIRE(outcome.code == 0);
    return read_columns(file);
  };
  auto plain = simulate("--rate 500");
  auto read = simulate("--rate 250 --set " + loud + "_sensor_gain=0.5 --set " + late +
                       "_sensor_delay=0.008");
  REQUIRE(plain.count(loud) == 1);
  REQUIRE(read[loud].size() == (plain[loud].size() + 1) / 2);
  double largest = 0.0;
  for (const double y : plain[late]) largest = std::fmax(largest, std::fabs(y));
  for (auto& [name, values] : read) {
    INFO(name);
    for (std::size_t i = 2; i < values.size(); ++i) {
      if (name == loud) {
        CHECK(values[i] == Approx(1.5 * plain[name][2 * i]).margin(1e-12));
      } else if (name == late) {
        CHECK(values[i] == Approx(plain[name][2 * i - 4]).margin(1e-6 * largest));
      } else {
        CHECK(values[i] == plain[name][2 * i]);
      }
    }
  }
}

TEST_CASE("A misspelled effect on the command line is told", "[io][effects]") {
  const std::string files = (kExamples / "vehicles/paper_sedan.toml").string() + " " +
                            (kExamples / "maneuvers/bump_20mps.toml").string();
  const test::TemporaryFolder folder;
  const test::Outcome outcome =
      test::run_program("simulate " + files + " -o " + (folder / "run.csv").string() +
                        " --set rear_damper_assymetry=0.3");
  CHECK(outcome.code == 2);
  CHECK_THAT(outcome.messages, Catch::Contains("did you mean 'rear_damper_asymmetry'?"));
}

TEST_CASE("An effect is an axis of a sweep's grid", "[io][effects]") {
  const test::TemporaryFolder folder;
  const std::string text =
      "vehicle = \"" + (kExamples / "vehicles/paper_sedan.toml").string() + "\"\n" +
      "maneuver = \"" + (kExamples / "maneuvers/bump_20mps.toml").string() + "\"\n" +
      "[grid]\nrear_damper_asymmetry = { from = 0.0, to = 0.4, step = 0.2 }\n"
      "front_stiffness = { from = 40000, to = 38000, step = -1000 }\n"
      "[integrate]\nclosure = \"table\"\nstep = 1e-3\n"
      "[record]\nsnapshot = { when = \"rear_wheels_on_bump\", channels = [\"pitch_rate\"] }\n";
  const std::string sweep = folder.write("sweep.toml", text), out = folder / "out";
  const test::Outcome plan = test::run_program("plan " + sweep + " -o " + out);
  INFO(plan.messages);
  REQUIRE(plan.code == 0);
  const test::Outcome run = test::run_program("run " + out + " --threads 1");
  INFO(run.messages);
  REQUIRE(run.code == 0);
  const test::Outcome check = test::run_program("verify " + out + " --sample 4");
  INFO(check.out << check.messages);
  CHECK(check.code == 0);
}

}  // namespace
}  // namespace strut
