// The generator's car and the vehicle file that describes it are one car: by the tested program.
#include "tests/hidden/vehicle_file.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "tests/hidden/simulate_kit.h"
#include "tests/jobs/run_program.h"
#include "tests/support/tolerance.h"

namespace strut::hidden {
namespace {

using test::tolerance;

/// Columns of the program's CSV by the channel's name, without the unit.
std::map<std::string, std::vector<double>> read_columns(const std::string& path) {
  std::ifstream in(path);
  std::string line;
  std::vector<std::string> names;
  std::map<std::string, std::vector<double>> columns;
  while (std::getline(in, line)) {
    if (line.empty() || line.front() == '#') continue;
    std::istringstream cells(line);
    std::string cell;
    for (std::size_t i = 0; std::getline(cells, cell, ','); ++i) {
      if (names.size() <= i && columns.empty()) {
        names.push_back(cell.substr(0, cell.find_first_of(" [")));
      } else {
        columns[names.at(i)].push_back(std::stod(cell));
      }
    }
  }
  return columns;
}

void write(const std::string& path, const std::string& text) { std::ofstream(path) << text; }

}  // namespace

TEST_CASE("Hidden data: the program simulates the same car from its vehicle file", "[io]") {
  const Kit kit = make_kit("car");
  const test::TemporaryFolder folder;
  const Car car = make_nominal_car();
  write(folder / "car.toml", make_vehicle_file(car, kFootprint, "tire.tir"));
  write(folder / "tire.tir", make_tire_file(car.wheel[0].tire, 3000.0));
  // The one-sided crossing moves everything: heave, pitch, roll, yaw.
  const std::size_t run = 4;
  const RunPlan& plan = kit.runs[run];
  REQUIRE(plan.one_sided);
  write(folder / "left.toml",
        "speed = " + format(plan.speed) + "\nduration = " + format(plan.duration) +
            "\ndrive_torque = 0.0\n[bump]\nshape = \"cosine\"\nside = \"left\"\nheight = " +
            format(plan.bump.height) + "\nlength = " + format(plan.bump.length) +
            "\ndistance = " + format(plan.distance) + "\n");
  const std::string out = folder / "left.csv";
  const auto outcome =
      test::run_program("simulate " + std::string(folder / "car.toml") + " " +
                        std::string(folder / "left.toml") + " --rate 500 -o " + out);
  INFO(outcome.messages);
  REQUIRE(outcome.code == 0);
  const auto columns = read_columns(out);
  const auto own = simulate_run(kit, make_nominal_truth(kit), run, 500.0, 0.0);
  for (std::size_t c = 0; c < kit.sensors.size(); ++c) {
    const std::vector<double>& theirs = columns.at(kit.sensors[c].channel);
    const std::size_t count = std::min(theirs.size(), own[c].value.size());
    REQUIRE(count > 1400);
    double square = 0.0;
    for (std::size_t i = 0; i < count; ++i) square += std::pow(theirs[i] - own[c].value[i], 2);
    INFO(kit.sensors[c].channel);
    // Arms of 10 m instead of straight guides: a fiftieth of the sensors' noise.
    CHECK(std::sqrt(square / static_cast<double>(count)) < tolerance(0.05 * kit.sensors[c].noise));
  }
}

}  // namespace strut::hidden
