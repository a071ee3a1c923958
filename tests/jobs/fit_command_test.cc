// strut identify VEHICLE.toml: simulated by the program, identified by the program.

#include <catch2/catch.hpp>
#include <filesystem>
#include <string>

#include "base/text/format_number.h"
#include "io/table/csv.h"
#include "tests/jobs/check_hint.h"
#include "tests/jobs/parse_json.h"
#include "tests/jobs/run_program.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::run_program;

const std::string kExamples = STRUT_SOURCE_DIR "/examples";
const std::string kVehicle = kExamples + "/vehicles/paper_sedan.toml";
const std::string kManeuver = kExamples + "/maneuvers/bump_20mps.toml";

/// A worn car's run at 200 Hz.
std::string simulate(const test::TemporaryFolder& folder, const std::string& name) {
  std::string file = folder / name;
  REQUIRE(
      run_program("simulate " + kVehicle + " " + kManeuver +
                  " --set front_stiffness=37000 --set rear_damping=1850 --step 0.0005 --rate 200 "
                  "-o " +
                  file)
          .code == 0);
  return file;
}

std::string fit(const std::string& rest) {
  return "identify " + kVehicle + " " + rest + " --maneuver " + kManeuver;
}

TEST_CASE("identify fits a simulated history and gives its parameters back", "[io]") {
  const test::TemporaryFolder folder;
  const std::string file = simulate(folder, GENERATE("run.csv", "run.h5"));
  const test::Outcome outcome = run_program(fit(file) + " --window 0.3:2 --json");
  CHECK(outcome.code == 0);
  const auto json = test::parse_json(outcome.out);
  CHECK(test::check_hint(outcome.messages)[1] == "simulate");
  CHECK(json.get<double>("parameters.front_stiffness.value") == Approx(37000.0).epsilon(1e-3));
  CHECK(json.get<double>("parameters.front_damping.value") == Approx(1980.0).epsilon(1e-3));
  CHECK(json.get<double>("parameters.rear_stiffness.value") == Approx(35000.0).epsilon(1e-3));
  CHECK(json.get<double>("parameters.rear_damping.value") == Approx(1850.0).epsilon(1e-3));
  CHECK(json.get<bool>("in_range"));
  CHECK(json.get<bool>("converged"));
  CHECK(json.get<double>("chi2_per_dof") < 0.01);
  CHECK(json.get_child("nuisances").size() == 4);
  const auto& interval = json.get_child("parameters.front_stiffness.ci95");
  CHECK(interval.front().second.get_value<double>() < 37000.0);
  CHECK(interval.back().second.get_value<double>() > 37000.0);
}

TEST_CASE("identify by a fit tells what is not identifiable", "[io]") {
  const test::TemporaryFolder folder;
  const std::string file = simulate(folder, "run.csv");
  const std::string options =
      " --window 0.3:1.5 --free rear_damping,yaw_inertia --set front_stiffness=37000";
  const test::Outcome outcome = run_program(fit(file) + options);
  CHECK(outcome.code == 1);
  CHECK_THAT(outcome.messages, Contains("not identifiable: yaw_inertia, which moves no reading"));
  CHECK(test::check_hint(outcome.messages)[1] == "design");
  CHECK_THAT(outcome.out, Contains("rear_damping"));
  const test::Outcome two = run_program(fit(file + " " + file) + options + " --json");
  CHECK(test::parse_json(two.out).get_child("nuisances").size() == 8);
  CHECK(test::parse_json(two.out).get_child("channels").size() == 4);
}

TEST_CASE("identify by a fit refuses wrong input", "[io]") {
  const test::TemporaryFolder folder;
  const std::string good = folder.write("good.csv",
                                        "time,imu_acceleration_z,imu_rate_y\n0.5,9.8,0\n0.6,9.8,0\n"
                                        "0.7,9.8,0\n0.8,9.8,0\n0.9,9.8,0\n1.0,9.8,0\n");
  const std::string back =
      folder.write("back.csv", "time,imu_acceleration_z,imu_rate_y\n0.5,9.8,0\n0.4,9.8,0\n");
  const std::string other = folder.write("other.csv", "time,imu_rate_y\n0.5,0\n");
  const std::string empty =
      folder.write("nan.csv", "time,imu_acceleration_z,imu_rate_y\n0.5,nan,0\n");
  const std::string rows = "0.5,9.8,0\n0.6,9.8,0\n", names = "time,imu_acceleration_z,imu_rate_y\n";
  const std::string late = folder.write("late.csv", names + "100.5,9.8,0\n101,9.8,0\n");
  const std::string unit = folder.write("unit.csv", names + "# units: s,N,rad/s\n" + rows);
  const std::string clock = folder.write("clock.csv", names + "# units: mm,,\n" + rows);
  const std::string taken = folder.write("taken.csv", "mine");
  const std::pair<std::string, std::string> cases[] = {
      {"identify " + kVehicle + " " + good, "--maneuver: missing"},
      {"identify " + kExamples + "/rigs/quarter_car.toml " + good + " --maneuver " + kManeuver,
       "is a rig; identify fits cars only"},
      {fit(back), "must be finite and ascend"},
      {fit(other), "no column 'imu_acceleration_z'"},
      {fit(empty), "finite"},
      {fit(good) + " --free front_stifness", "did you mean 'front_stiffness'"},
      {fit(good) + " --channels front_left_spring_force", "--noise front_left_spring_force=SIGMA"},
      {fit(good) + " --event-time 0.6", "--event-time: allowed with a model's snapshot only"},
      {"identify model.h5 " + good + " --window 0:1", "allowed with VEHICLE.toml only"},
      {fit(good) + " --window 0.8", "FROM:TO"},
      {fit(good) + " --window 2:3", "no sample"},
      {fit(good) + " --prior sped=20,1", "did you mean 'speed'"},
      {fit(good) + " --prior speed=20", "NAME=MEAN,SIGMA"},
      {fit(good) + " --prior hit_time=0,0", "sigma must be > 0"},
      {fit(late), "time runs from 100.5 to 101 s, the maneuver from 0 to 3 s"},
      {fit(unit), "unit.csv: column 'imu_acceleration_z': unit \"N\""},
      {fit(clock), "clock.csv: column 'time': unit \"mm\""},
      {fit(good) + " -o " + good + " --force", "is an input of this command"},
      {fit(good) + " -o " + taken, "taken.csv: exists; --force replaces it"},
      {"identify " + kVehicle + " " + good + " --maneuver " + other + " --force -o " + other,
       "is an input of this command"},
      {fit(good) + " --set front_stiffness=1000", "cannot carry the car"},
      {fit(good + " " + good) + " --maneuver " + kManeuver + " --maneuver " + kManeuver,
       "one for all, or one for each"}};
  for (const auto& [command, message] : cases) {
    INFO(command);
    const test::Outcome outcome = run_program(command);
    CHECK(outcome.code == 2);
    CHECK_THAT(outcome.messages, Contains(message));
  }
  CHECK(test::read_text(taken) == "mine");
}

TEST_CASE("identify by a fit tells what is amiss with a record", "[io]") {
  const test::TemporaryFolder folder;
  std::string dead = "time,imu_acceleration_z,imu_rate_y\n", late = dead;
  const CsvTable table = read_csv(simulate(folder, "run.csv"));
  const auto& times = table.column("time").values;
  const auto& accelerations = table.column("imu_acceleration_z").values;
  const auto& rates = table.column("imu_rate_y").values;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const std::string time = format_number(times[i]), rate = format_number(rates[i]) + "\n";
    dead += time + ",9.81," + rate;
    late += format_number(times[i] + 0.04) + "," + format_number(accelerations[i]) + "," + rate;
  }
  const test::Outcome stuck =
      run_program(fit(folder.write("dead.csv", dead)) + " --window 0.3:1.5");
  CHECK(stuck.code == 1);
  CHECK_THAT(stuck.messages,
             Contains("imu_acceleration_z is 9.81 in all 241 readings: does its sensor work?") &&
                 Contains("residuals are larger than the noise") &&
                 Contains("dead.csv: imu_acceleration_z: chi2 "));
  CHECK(test::check_hint(stuck.messages)[1] == "compare");
  // 8 sigma of the clock off: its bound is no answer, and a wider one is.
  const std::string shifted = fit(folder.write("late.csv", late)) + " --window 0.3:1.5";
  const test::Outcome held = run_program(shifted);
  CHECK(held.code == 1);
  CHECK_THAT(held.messages, Contains("hit_time = -0.025 s: held by its bound"));
  const test::Outcome wider = run_program(shifted + " --prior hit_time=0,0.03");
  CHECK(wider.code == 0);
  CHECK_THAT(wider.messages, Contains("the residuals are smaller than the noise"));
  CHECK_THAT(wider.out, Contains("hit_time") && Contains("-0.0400"));
}

}  // namespace
}  // namespace strut
