// The program as a user meets it: arguments in, exit code, messages and files out.
#include <array>
#include <catch2/catch.hpp>
#include <cstdio>

#include "io/format/hdf5.h"
#include "io/format/json.h"
#include "io/table/csv.h"
#include "model/channel/car_channels.h"
#include "tests/jobs/parse_json.h"
#include "tests/jobs/run_program.h"
#include "tests/support/temporary_folder.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::Outcome;
using test::read_text;
using test::run_shell;
using test::TemporaryFolder;

const std::string kProgram = STRUT_PROGRAM;
const std::string kExamples = STRUT_SOURCE_DIR "/examples";
const std::string kSedan = kExamples + "/vehicles/paper_sedan.toml";
const std::string kBump = kExamples + "/maneuvers/bump_20mps.toml";
const std::string kRig = kExamples + "/rigs/quarter_car.toml";
const std::string kRigBump = kExamples + "/rigs/maneuvers/bump.toml";

Outcome run(const std::string& arguments) { return test::run_program(arguments); }

/// The example car with one text replaced, which must be there.
std::string change_example(const TemporaryFolder& folder, const std::string& file,
                           const std::string& old_text, const std::string& new_text) {
  std::string text = read_text(file);
  const auto replace = [&text](const std::string& from, const std::string& to) {
    const auto at = text.find(from);
    REQUIRE(at != std::string::npos);
    text.replace(at, from.size(), to);
  };
  replace(old_text, new_text);
  if (text.find("\"../tires/") != std::string::npos) replace("../tires/", kExamples + "/tires/");
  return folder.write("changed.toml", text);
}

/// Runs a case that must be refused: exit code 2, nothing written, every text in the message.
void check_refused(const std::string& vehicle, const std::string& maneuver,
                   const std::string& options, const std::vector<std::string>& texts) {
  for (const char* name : {"run.csv", "run.h5"}) {
    const TemporaryFolder folder;
    const Outcome outcome = run("simulate " + vehicle + " " + maneuver + " -o " +
                                (folder / name).string() + " " + options);
    CHECK(outcome.code == 2);
    CHECK(outcome.out.empty());
    CHECK(folder.file_count() == 0);
    for (const std::string& text : texts) CHECK_THAT(outcome.messages, Contains(text));
  }
}

TEST_CASE("Every command explains itself with an example", "[unit][io]") {
  for (const char* command : {"simulate", "bench"}) {
    const Outcome outcome = run(std::string(command) + " --help");
    CHECK(outcome.code == 0);
    CHECK(outcome.messages.empty());
    CHECK_THAT(outcome.out, Contains("Usage: strut ") && Contains("Examples:\n  strut "));
  }
  CHECK_THAT(run("--help").out, Contains("simulate") && Contains("bench"));
}

TEST_CASE("The version says what could differ between two programs", "[unit][io]") {
  const Outcome outcome = run("--version");
  CHECK(outcome.code == 0);
  CHECK_THAT(outcome.out, Contains("strut 0.") && Contains("compiler:") && Contains("baseline") &&
                              Contains("HDF5: 1.") && Contains("SUNDIALS: "));
}

TEST_CASE("An unknown command or option suggests the nearest", "[unit][io]") {
  const Outcome command = run("simulat");
  CHECK(command.code == 2);
  CHECK(command.out.empty());
  CHECK_THAT(command.messages, Contains("'simulat'") && Contains("did you mean 'simulate'?"));
  CHECK(run("").code == 2);
  const Outcome option = run("simulate a b --intgrator rk4");
  CHECK(option.code == 2);
  CHECK_THAT(option.messages, Contains("did you mean '--integrator'?"));
}

TEST_CASE("A run writes every channel with its unit as CSV and prints the snapshot", "[io]") {
  const TemporaryFolder folder;
  const std::string file = folder / "run.csv";
  const Outcome outcome = run("simulate " + kSedan + " " + kBump + " -o " + file);
  CHECK(outcome.code == 0);
  CHECK_THAT(outcome.out, Contains("event_time") && Contains("pitch_rate"));
  const CsvTable table = read_csv(file);
  REQUIRE(table.columns.size() == list_car_channels().size());
  CHECK(table.row_count() == 3001);
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    CHECK(table.columns[c].name == list_car_channels()[c].name);
    CHECK(table.columns[c].unit == list_car_channels()[c].unit);
  }
  CHECK(table.column("time").values.back() == Approx(3.0).epsilon(1e-12));
  CHECK(folder.file_count() == 1);
}

TEST_CASE("HDF5 holds the same run as CSV, with parameters and provenance", "[io]") {
  const TemporaryFolder folder;
  const std::string csv = folder / "run.csv", h5 = folder / "run.h5";
  const std::string options = " --rate 200 --set front_stiffness=38000 --integrator abm4";
  REQUIRE(run("simulate " + kSedan + " " + kBump + options + " -o " + csv).code == 0);
  const Outcome outcome = run("simulate " + kSedan + " " + kBump + options + " --json -o " + h5);
  REQUIRE(outcome.code == 0);
  const CsvTable table = read_csv(csv);
  const Hdf5Reader reader(h5);
  for (const ChannelInfo& channel : list_car_channels()) {
    const Hdf5Dataset dataset = reader.read("/history/" + channel.name);
    CHECK(dataset.values == table.column(channel.name).values);
    CHECK(dataset.label.unit == channel.unit);
    CHECK(dataset.label.description == channel.description);
  }
  CHECK(reader.read("/parameters/front_stiffness").values.front() == 38000.0);
  CHECK(reader.read("/parameters/front_stiffness").label.unit == "N/m");
  CHECK(reader.read_attribute("/", "integrator") == "abm4");
  CHECK(reader.read_attribute("/", "vehicle") == kSedan);

  const test::JsonTree json = test::parse_json(outcome.out);
  CHECK(json.get<double>("event_time") == reader.read("/snapshot/event_time").values.front());
  for (const char* name :
       {"body_position_z", "body_velocity_z", "body_acceleration_z", "pitch_angle", "pitch_rate"}) {
    CHECK(json.get<double>(std::string("snapshot.") + name) ==
          reader.read(std::string("/snapshot/") + name).values.front());
  }
}

TEST_CASE("simulate writes the channels that are named, and the time", "[io]") {
  const TemporaryFolder folder;
  const std::string command = "simulate " + kSedan + " " + kBump + " --rate 50 ";
  const std::string csv = folder / "some.csv", h5 = folder / "some.h5";
  const std::string named = "--channels pitch_rate,body_position_z -o ";
  REQUIRE(run(command + named + csv).code == 0);
  CHECK_THAT(test::read_text(csv), Catch::StartsWith("time,body_position_z,pitch_rate\n"));
  REQUIRE(run(command + named + h5).code == 0);
  CHECK(Hdf5Reader(h5).list("/history") ==
        std::vector<std::string>{"body_position_z", "pitch_rate", "time"});
  const Outcome unknown = run(command + "--channels pitch_rat -o " + (folder / "no.csv").string());
  CHECK(unknown.code == 2);
  CHECK_THAT(unknown.messages, Contains("--channels") && Contains("did you mean 'pitch_rate'?"));
}

TEST_CASE("Integrators and closures agree on the snapshot", "[io]") {
  // Measured: within 9e-7 of cvode, most without located events; five times that.
  const TemporaryFolder folder;
  const auto snapshot = [&](const std::string& options) {
    const Outcome outcome = run("simulate " + kSedan + " " + kBump + " -o " +
                                (folder / "run.csv").string() + " --force --json " + options);
    REQUIRE(outcome.code == 0);
    const test::JsonTree json = test::parse_json(outcome.out);
    return json.get<double>("snapshot.body_acceleration_z");
  };
  const double truth = snapshot("--integrator cvode");
  CHECK(snapshot("--integrator rk4 --step 0.00025") == Approx(truth).epsilon(5e-6));
  CHECK(snapshot("--integrator abm4 --step 0.00025") == Approx(truth).epsilon(5e-6));
  CHECK(snapshot("--step 0.00025 --closure table") == Approx(truth).epsilon(5e-6));
  CHECK(snapshot("--step 0.00025 --spin explicit --no-events") == Approx(truth).epsilon(5e-6));
}

TEST_CASE("Kinematics have the columns and rows that were agreed on", "[io]") {
  const TemporaryFolder folder;
  const std::string file = folder / "curves.csv";
  const Outcome outcome = run("simulate --kinematics " + kSedan + " -o " + file);
  CHECK(outcome.code == 0);
  CHECK(outcome.out.empty());
  std::istringstream text(read_text(file));
  std::string line;
  std::getline(text, line);
  CHECK(line ==
        "wheel_travel,camber_rad,toe_rad,wc_dx,wc_dy,wc_dz,caster_change_rad,spring_len,damper_len,"
        "axle,track");
  int front = 0, rear = 0;
  while (std::getline(text, line)) {
    front += line.find(",front,") != std::string::npos ? 1 : 0;
    rear += line.find(",rear,") != std::string::npos ? 1 : 0;
  }
  CHECK(front == 81);
  CHECK(rear == 81);
}

TEST_CASE("An unknown key is refused with file, line and the nearest key", "[io]") {
  const TemporaryFolder folder;
  const std::string vehicle =
      change_example(folder, kSedan, "centroid_height = ", "centroid_hight = ");
  check_refused(vehicle, kBump, "", {vehicle + ":", "centroid_height"});
  const std::string maneuver =
      change_example(folder, kBump, "gravity = 9.81", "gravity = 9.81\nwind = 3.0");
  check_refused(kSedan, maneuver, "", {maneuver + ":", "wind"});
}

TEST_CASE("A missing file is refused by name", "[io]") {
  check_refused("/nowhere/car.toml", kBump, "", {"/nowhere/car.toml"});
  check_refused(kSedan, "/nowhere/bump.toml", "", {"/nowhere/bump.toml"});
}

TEST_CASE("A negative mass is refused with key, value and allowed range", "[io]") {
  const TemporaryFolder folder;
  const std::string vehicle = change_example(folder, kSedan, "mass = 1155.0", "mass = -1155.0");
  check_refused(vehicle, kBump, "", {vehicle + ":", "whole_car.mass", "-1155", "must lie in [200"});
  check_refused(kSedan, kBump, "--set mass=-5", {"--set mass = -5", "must lie in [200"});
}

TEST_CASE("Hardpoints that cannot close the loop are refused", "[io]") {
  const TemporaryFolder folder;
  // A tie rod of 34 mm in place of 340 mm.
  const std::string vehicle = change_example(folder, kSedan, "chassis = [-0.16387, 0.3047, 0.0495]",
                                             "chassis = [-0.12817, 0.609, 0.02844]");
  check_refused(vehicle, kBump, "", {vehicle, "front_suspension", "close the loop", "allowed"});
  const Outcome curves =
      run("simulate --kinematics " + vehicle + " -o " + (folder / "curves.csv").string());
  CHECK(curves.code == 2);
  CHECK(folder.file_count() == 1);
}

TEST_CASE("The program refuses a spring that cannot carry the car", "[io]") {
  const TemporaryFolder folder;
  const std::string vehicle = change_example(folder, kSedan, "stiffness = 40000.0",
                                             "stiffness = 2000.0\n"
                                             "nominal_stiffness = 40000.0");
  check_refused(vehicle, kBump, "",
                {vehicle, "front_suspension.spring.stiffness = 2000 N/m", "cannot carry the car",
                 "allowed: at least"});
}

TEST_CASE("A step that is unstable is refused with the longest stable one", "[io]") {
  check_refused(kSedan, kBump, "--step 0.005 --spin explicit",
                {"--step = 0.005", "unstable", "must lie in (0, 0.004", "--spin exponential"});
  check_refused(kSedan, kExamples + "/maneuvers/bump_3mps.toml", "--spin explicit",
                {"--step = 0.001", "unstable", "must lie in (0, 0.0006"});
  check_refused(kSedan, kBump, "--step 0.021", {"--step = 0.021", "must lie in (0, 0.02] s"});
  check_refused(kSedan, kBump, "--step 0", {"must lie in (0, 0.02] s"});
  check_refused(kSedan, kBump, "--step nan", {"--step = nan", "must lie in (0, 0.02] s"});
}

TEST_CASE("A coarse step away from the bump keeps the snapshot and is on record", "[io]") {
  const TemporaryFolder folder;
  const std::string fine = folder / "fine.h5", coarse = folder / "coarse.h5";
  const std::string car = "simulate " + kSedan + " " + kBump + " -o ";
  REQUIRE(run(car + fine).code == 0);
  REQUIRE(run(car + coarse + " --coarse-step 0.004").code == 0);
  const Hdf5Reader reader(coarse), fine_reader(fine);
  const auto acceleration = [](const Hdf5Reader& r) {
    return r.read("/snapshot/body_acceleration_z").values.front();
  };
  CHECK(reader.read_attribute("/", "coarse_step") == "0.004 s");
  CHECK_THROWS(fine_reader.read_attribute("/", "coarse_step"));
  // Measured: 9e-8 apart, less than the fine step is off; five times that.
  CHECK(acceleration(reader) == Approx(acceleration(fine_reader)).epsilon(5e-7));
  CHECK(acceleration(reader) != acceleration(fine_reader));

  check_refused(kSedan, kBump, "--step 0.002 --coarse-step 0.001",
                {"--coarse-step = 0.001", "must lie in [0.002, 0.02] s"});
  check_refused(kSedan, kBump, "--coarse-step 0.021", {"must lie in [0.001, 0.02] s"});
  check_refused(kSedan, kBump, "--coarse-step 0.005 --spin explicit",
                {"--coarse-step = 0.005", "unstable", "must lie in (0, 0.004"});
  check_refused(kSedan, kBump, "--coarse-step 0.004 --integrator cvode", {"--coarse-step: cvode"});
  check_refused(kRig, kRigBump, "--coarse-step 0.004", {"--coarse-step: ", "is a rig"});
}

TEST_CASE("Options that would have no effect are refused", "[io]") {
  for (const std::string option : {"--step 0.001", "--spin explicit", "--no-events"}) {
    check_refused(kSedan, kBump, "--integrator cvode " + option,
                  {option.substr(0, option.find(' ')) + ": cvode", "allowed with rk4 and abm4"});
  }
  check_refused(kRig, kRigBump, "--closure table", {"--closure: ", "is a rig", "for cars"});
  check_refused(kRig, kRigBump, "--spin explicit", {"--spin: ", "is a rig", "for cars"});
  check_refused(kRig, kRigBump, "--integrator cvode", {"must be rk4 or abm4 for a rig"});
  const TemporaryFolder folder;
  for (const std::string option : {"--integrator rk4", "--step 0.001", "--coarse-step 0.002",
                                   "--closure table", "--spin explicit", "--no-events"}) {
    const Outcome outcome = run("simulate --kinematics " + kSedan + " -o " +
                                (folder / "curves.csv").string() + " " + option);
    CHECK(outcome.code == 2);
    CHECK(folder.file_count() == 0);
    CHECK_THAT(outcome.messages,
               Contains(option.substr(0, option.find(' ')) + ": --kinematics does not simulate"));
  }
}

TEST_CASE("A rig's step that diverges is refused with one that succeeds", "[io]") {
  // Its wheel hop, 207 rad/s, times 20 ms is 4.1; RK4 is stable up to 2.8.
  check_refused(kRig, kRigBump, "--step 0.02 --set unsprung_mass=0.05 --set damping=0.1",
                {"--step = 0.02", "diverged at t = ", "a step of 0.0025 s succeeds"});
}

TEST_CASE("Bad options are refused with what is allowed", "[io]") {
  check_refused(kSedan, kBump, "--integrator euler", {"euler", "rk4, abm4, cvode"});
  check_refused(kSedan, kBump, "--integrator cvode --step 0.001", {"--step", "cvode"});
  check_refused(kSedan, kBump, "--set front_stifness=1", {"did you mean 'front_stiffness'?"});
  check_refused(kSedan, kBump, "--rate 0", {"--rate = 0", "must lie in [1"});
  check_refused(kSedan, "", "", {"expected VEHICLE and MANEUVER", "Usage:"});
  const TemporaryFolder folder;
  const Outcome outcome =
      run("simulate " + kSedan + " " + kBump + " -o " + (folder / "run.txt").string());
  CHECK(outcome.code == 2);
  CHECK_THAT(outcome.messages, Contains("run.txt") && Contains(".csv, .h5 or .hdf5"));
}

TEST_CASE("A folder that is not there is the environment's failure", "[io]") {
  for (const char* name : {"run.csv", "run.h5"}) {
    const std::string file = std::string("/nowhere/") + name;
    const Outcome outcome = run("simulate " + kSedan + " " + kBump + " -o " + file);
    CHECK(outcome.code == 3);
    CHECK_THAT(outcome.messages, Contains(file));
  }
}

TEST_CASE("Output that cannot be written is told, and no next command", "[io]") {
  const TemporaryFolder folder;
  const std::string file = folder / "a.h5";
  const std::string shard = folder / "cars/shards/000000.h5", model = folder / "m.h5";
  REQUIRE(
      run("plan " + kExamples + "/api/small_sweep.toml -q -o " + (folder / "cars").string()).code ==
      0);
  REQUIRE(run("run -q " + (folder / "cars").string()).code == 0);
  REQUIRE(run("train -q --allow-few --hidden 3 --epochs 5 " + shard + " -o " + model).code == 0);
  for (const std::string& command :
       {"simulate " + kSedan + " " + kBump + " --force -o " + file,
        "identify " + model + " " + file, "evaluate " + model + " " + shard,
        "status " + (folder / "cars").string()}) {
    INFO(command);
    // Closed, a pipe or disk that is full: what was asked for is lost.
    for (const char* out : {" >/dev/full", " >&-"}) {
      const Outcome outcome = run(command + out);
      CHECK(outcome.code == 3);
      CHECK_THAT(outcome.messages, Contains("standard output") && !Contains("next:"));
    }
  }
}

TEST_CASE("A file that is read is not written", "[io]") {
  const TemporaryFolder folder;
  const std::string profile = folder / "profile.csv", road = folder / "road.toml";
  std::filesystem::copy_file(kExamples + "/maneuvers/measured_profile.csv", profile);
  std::string text = read_text(kExamples + "/maneuvers/measured_profile.toml");
  text.replace(text.find("measured_profile.csv"), 20, "profile.csv");
  folder.write("road.toml", text);
  const std::string input = folder.write("input.csv", "t_s,road_m\n0,0\n1,0.001\n2,0\n");
  const std::string plate =
      folder.write("plate.toml",
                   "duration = 2.0\n[input.road_position]\nshape = \"file\"\nfile = \"input.csv\"\n"
                   "time = \"t_s\"\ncolumn = \"road_m\"\n");
  const std::string sweep = folder / "sweep.toml";
  text = read_text(kExamples + "/api/small_sweep.toml");
  for (auto at = text.find("\"../"); at != std::string::npos; at = text.find("\"../")) {
    text.replace(at, 4, "\"" + kExamples + "/");
  }
  folder.write("sweep.toml", text);

  const std::pair<std::string, std::string> cases[] = {
      {"simulate " + kSedan + " " + road + " --force -o ", profile},
      {"simulate " + kRig + " " + plate + " --force -o ", input},
      {"design " + sweep + " --rate 100 --force --csv ", sweep}};
  for (const auto& [command, file] : cases) {
    INFO(command);
    const std::string before = read_text(file);
    const Outcome refused = run(command + file);
    CHECK(refused.code == 2);
    CHECK_THAT(refused.messages, Contains(file + ": is an input of this command"));
    CHECK(read_text(file) == before);
    const Outcome allowed = run(command + (folder / "other.csv").string());
    INFO(allowed.messages);
    CHECK(allowed.code == 0);
  }
}

TEST_CASE("A run that leaves the modeled travel says when, writes nothing, and answers no",
          "[io]") {
  const TemporaryFolder folder;
  const Outcome outcome =
      run("simulate " + kSedan + " " + kBump + " --set bump_height=0.19 --closure table -o " +
          (folder / "run.csv").string());
  CHECK(outcome.code == 1);
  CHECK_THAT(outcome.messages, Contains("failed at t = 0.") && Contains("100 mm"));
  CHECK(folder.file_count() == 0);
}

TEST_CASE("SIGINT and SIGTERM end a run with 130 and 143 and leave nothing", "[io]") {
  const std::pair<const char*, int> signals[] = {{"INT", 130}, {"TERM", 143}};
  for (const auto& [signal, code] : signals) {
    const TemporaryFolder folder;
    // An hour of driving takes a minute.
    const Outcome outcome = run_shell(
        std::string("timeout --preserve-status -s ") + signal + " 0.5 " + kProgram + " simulate " +
        kSedan + " " + kBump + " --rate 1 --set duration=3600 -o " + (folder / "run.csv").string());
    CHECK(outcome.code == code);
    CHECK(folder.file_count() == 0);
  }
}

TEST_CASE("JSON escapes text, nests, and has no number that is not finite", "[unit]") {
  const Json json = {{"text", "a\"b\\c\n"},
                     {"number", 0.1},
                     {"nothing", std::nan("")},
                     {"list", {1, true, "x"}},
                     {"empty", Json::object()}};
  CHECK(format_json(json) ==
        "{\n"
        "  \"text\": \"a\\\"b\\\\c\\n\",\n"
        "  \"number\": 0.1,\n"
        "  \"nothing\": null,\n"
        "  \"list\": [1, true, \"x\"],\n"
        "  \"empty\": {}\n"
        "}");
}

}  // namespace
}  // namespace strut
