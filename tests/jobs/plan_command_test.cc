// `strut plan` as a user meets it: what it prints, the folder it makes, what it refuses.
#include <sys/resource.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <map>
#include <utility>

#include "io/format/hdf5.h"
#include "sweep/folder.h"
#include "tests/jobs/parse_json.h"
#include "tests/jobs/program_sweep.h"
#include "tests/jobs/run_program.h"
#include "tests/support/sweep_text.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

using Catch::Matchers::Contains;
using test::make_sweep_text;
using test::Outcome;
using test::read_text;
using test::Replacements;
using test::run_program;
using test::TemporaryFolder;

/// A setting that runs quickly.
const Replacements kFast = {{"\"newton\"", "\"table\""}, {"1e-3", "2e-3"}};

std::string plan(const TemporaryFolder& folder, const std::string& text) {
  folder.write("sweep.toml", text);
  return "plan " + (folder / "sweep.toml").string() + " -o " + (folder / "sweep").string();
}

void check_plan_refused(const std::string& text, const std::vector<std::string>& says) {
  const TemporaryFolder folder;
  const Outcome outcome = run_program(plan(folder, text));
  CHECK(outcome.code == 2);
  CHECK(outcome.out.empty());
  CHECK_FALSE(fs::exists(folder / "sweep"));
  CHECK_THAT(outcome.messages, Contains("sweep.toml"));
  for (const std::string& what : says) CHECK_THAT(outcome.messages, Contains(what));
}

std::map<std::string, std::string> read_all(const fs::path& root) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    const bool file = entry.is_regular_file();
    files[entry.path().string()] = file ? read_text(entry.path()) : "";
  }
  return files;
}

TEST_CASE("A dry run prints every layer's counts, shards, time and bytes, and writes nothing",
          "[io]") {
  const TemporaryFolder folder;
  const std::string command =
      plan(folder, make_sweep_text({{"\"all\"", "2000"}, {"\"newton\"", "\"table\""}}));
  const Outcome outcome = run_program(command + " --dry-run");
  CHECK(outcome.code == 0);
  CHECK(folder.file_count() == 1);
  CHECK_THAT(outcome.out, Contains("2000 of the grid's 10000 points"));
  CHECK_THAT(outcome.out,
             Contains("10          35500          35500             1000              200"));
  CHECK_THAT(outcome.out, Contains("shards    4 of up to 512") && Contains("shuffled"));
  CHECK_THAT(outcome.out, Contains("time      about") && Contains("estimate"));
  CHECK_THAT(outcome.out, Contains("size      about"));
  const Outcome json = run_program(command + " --dry-run --json");
  const test::JsonTree tree = test::parse_json(json.out);
  CHECK(tree.get<int>("cases") == 2000);
  CHECK(tree.get<int>("shards") == 4);
  CHECK(tree.get_child("layers").size() == 10);
  CHECK(tree.get<double>("estimated_seconds") > 0.0);
  CHECK(tree.get<double>("estimated_bytes") > 2000 * 40);
  CHECK(tree.get<double>("estimated_core_hours") > 0.0);
  CHECK(tree.get<std::string>("plan_hash").size() == 64);
}

TEST_CASE("A step whose results are not those of a shorter one is told", "[io]") {
  const TemporaryFolder folder;
  const auto run = [&](const std::string& step) {
    const Replacements setting = {{"\"newton\"", "\"table\""}, {"\"all\"", "200"}, {"1e-3", step}};
    return run_program(plan(folder, make_sweep_text(setting)) + " --dry-run --json");
  };
  const Outcome long_step = run("0.02"), short_step = run("1e-3");
  CHECK_THAT(long_step.messages, Contains("warning: the step that the file gives is too long"));
  CHECK_THAT(short_step.messages, !Contains("warning"));
  CHECK(test::parse_json(long_step.out).get<double>("step_error") > 0.1);
  CHECK(test::parse_json(short_step.out).get<double>("step_error") < 1e-3);
}

TEST_CASE("CVODE and plan end where a car leaves its suspension's travel", "[io]") {
  const TemporaryFolder folder;
  const std::string examples = STRUT_SOURCE_DIR "/examples/";
  const Outcome run = test::run_shell(
      "timeout 30 " STRUT_PROGRAM " simulate " + examples + "vehicles/paper_sedan.toml " +
      examples + "maneuvers/bump_20mps.toml --integrator cvode --set rear_stiffness=13000 -o " +
      (folder / "run.csv").string());
  CHECK(run.code == 1);
  CHECK_THAT(run.messages, Contains("the run failed at t = 0.64") && Contains("+/-100 mm"));
  std::ofstream(folder / "soft.toml")
      << "vehicle = \"" << examples << "vehicles/paper_sedan.toml\"\nmaneuver = \"" << examples
      << "maneuvers/bump_20mps.toml\"\n[grid]\nrear_stiffness = { from = 13000, to = 35000, count "
         "= 3 }\n[record]\nsnapshot = { when = \"rear_wheels_on_bump\", offset = 0.0, channels = "
         "[\"pitch_rate\"] }\n";
  const Outcome planned = test::run_shell("timeout 60 " STRUT_PROGRAM " plan " +
                                          (folder / "soft.toml").string() + " --dry-run");
  CHECK(planned.code == 0);
  CHECK_THAT(planned.out, Contains("on 2 cases"));
}

/// Processor time of all child processes that have ended [s].
double read_child_seconds() {
  rusage usage{};
  ::getrusage(RUSAGE_CHILDREN, &usage);
  const auto add = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return add(usage.ru_utime) + add(usage.ru_stime);
}

std::uintmax_t sum_file_sizes(const fs::path& folder) {
  std::uintmax_t bytes = 0;
  for (const auto& entry : fs::directory_iterator(folder)) bytes += entry.file_size();
  return bytes;
}

/// Estimates of `strut plan` relative to what the run took: core-hours, bytes.
std::pair<double, double> measure_estimate() {
  const TemporaryFolder folder;
  const Replacements setting = {{"\"newton\"", "\"table\""}, {"\"all\"", "3000"}};
  const Outcome planned = run_program(plan(folder, make_sweep_text(setting)) + " --json");
  REQUIRE(planned.code == 0);
  const test::JsonTree told = test::parse_json(planned.out);
  const fs::path sweep = folder / "sweep";
  const Outcome dry = run_program("submit " + sweep.string() + " --to local --dry-run");
  CHECK_THAT(dry.out, Contains("about ") && Contains(" core-") && Contains("kB"));
  const double before = read_child_seconds();
  REQUIRE(run_program("run " + sweep.string()).code == 0);
  const double seconds = read_child_seconds() - before;
  return {
      3600.0 * told.get<double>("estimated_core_hours") / seconds,
      told.get<double>("estimated_bytes") / static_cast<double>(sum_file_sizes(sweep / "shards"))};
}

TEST_CASE("Core-hours and bytes that plan tells are those of the run within 20 %", "[io][slow]") {
  double nearest = 0.0;
  // Processor time depends on what else the machine does: the nearest of a few attempts counts.
  for (int attempt = 0; attempt < 4 && std::abs(nearest - 1.0) > 0.2; ++attempt) {
    const auto [time, bytes] = measure_estimate();
    CHECK(bytes == Approx(1.0).margin(0.2));
    if (std::abs(time - 1.0) < std::abs(nearest - 1.0)) nearest = time;
  }
  CHECK(nearest == Approx(1.0).margin(0.2));
}

TEST_CASE("The folder holds the request with every file it names, and runs on its own", "[io]") {
  const TemporaryFolder folder;
  // Everything from a place that is gone afterwards, by relative names.
  fs::create_directories(folder / "in");
  for (const char* part : {"vehicles", "maneuvers", "tires"}) {
    fs::copy(test::kExampleFolder + part, folder / "in" / part);
  }
  fs::create_directories(folder / "in" / "sweeps");
  std::string text = make_sweep_text(kFast);
  for (std::size_t at; (at = text.find(test::kExampleFolder)) != std::string::npos;) {
    text.replace(at, test::kExampleFolder.size(), "../");
  }
  text.replace(text.find("bump_20mps"), 10, "measured_profile");
  folder.write("in/sweeps/my.toml", text);
  const std::string sweep = folder / "sweep";
  const Outcome outcome =
      run_program("plan " + (folder / "in/sweeps/my.toml").string() + " -o " + sweep);
  INFO(outcome.messages);
  REQUIRE(outcome.code == 0);
  fs::remove_all(folder / "in");
  fs::rename(sweep, folder / "moved");

  const SweepFolder moved{folder / "moved"};
  const Plan opened = open_sweep_folder(moved);
  CHECK(opened.case_count() == 10000);
  const Hdf5Reader file(moved.plan());
  CHECK(file.read_attribute("/", "plan_hash") == opened.hash());
  CHECK(file.read("/layers").shape == std::vector<std::size_t>{10, 4});
  // Texts stay as they were but for the paths.
  const std::string request = read_text(moved.request());
  CHECK_THAT(request, Contains("vehicle  = \"request/paper_sedan.toml\"\n") &&
                          Contains("maneuver = \"request/measured_profile.toml\"\n") &&
                          Contains("# a point of the grid is one case"));
  CHECK(read_text(moved.inputs() / "paper_sedan.tir") ==
        read_text(test::kExampleFolder + "tires/paper_sedan.tir"));
  CHECK(read_text(moved.inputs() / "measured_profile.csv") ==
        read_text(test::kExampleFolder + "maneuvers/measured_profile.csv"));
  std::string sedan = read_text(test::kExampleFolder + "vehicles/paper_sedan.toml");
  sedan.replace(sedan.find("../tires/"), 9, "");
  CHECK(read_text(moved.inputs() / "paper_sedan.toml") == sedan);
  CHECK(run_program("simulate " + (moved.inputs() / "paper_sedan.toml").string() + " " +
                    (moved.inputs() / "measured_profile.toml").string() + " -o " +
                    (folder / "run.csv").string())
            .code == 0);
}

TEST_CASE("Planning the same again changes nothing", "[io]") {
  const TemporaryFolder folder;
  const std::string text = make_sweep_text(kFast);
  const std::string command = plan(folder, text);
  REQUIRE(run_program(command).code == 0);
  const auto before = read_all(folder / "sweep");
  CHECK(run_program(command).code == 0);
  CHECK(read_all(folder / "sweep") == before);
  // Not even by another file that asks for the same.
  CHECK(run_program(plan(folder, "# the same\n" + text)).code == 0);
  CHECK(read_all(folder / "sweep") == before);
}

TEST_CASE("A changed request in an old folder is refused with what changed", "[io]") {
  const TemporaryFolder folder;
  REQUIRE(run_program(plan(folder, make_sweep_text(kFast))).code == 0);
  const auto before = read_all(folder / "sweep");
  Replacements changed = kFast;
  changed.insert(changed.end(), {{"seed   = 1", "seed = 2"}, {"bump_20mps", "one_sided"}});
  const Outcome outcome = run_program(plan(folder, make_sweep_text(changed)));
  CHECK(outcome.code == 2);
  CHECK_THAT(outcome.messages, Contains("sample.seed: was 1, is 2") &&
                                   Contains("maneuver.bump.side: was both, is left") &&
                                   Contains("maneuver.bump.ramp: was absent, is 0.15"));
  CHECK(read_all(folder / "sweep") == before);
}

TEST_CASE("A folder whose files were edited since is no longer opened", "[io]") {
  const TemporaryFolder folder;
  const std::string command = plan(folder, make_sweep_text(kFast));
  REQUIRE(run_program(command).code == 0);
  const SweepFolder sweep{folder / "sweep"};
  const std::string car = read_text(sweep.inputs() / "paper_sedan.toml");
  std::string heavier = car;
  heavier.replace(heavier.find("1155"), 4, "1156");
  std::ofstream(sweep.inputs() / "paper_sedan.toml") << heavier;
  const auto changed = Contains("vehicle.whole_car.mass: was 1155, is 1156");
  CHECK_THROWS_WITH(open_sweep_folder(sweep), changed);
  const Outcome again = run_program(command);
  CHECK(again.code == 2);
  CHECK_THAT(again.messages, changed);
  std::ofstream(sweep.inputs() / "paper_sedan.toml") << car + "# a comment changes no result\n";
  CHECK_NOTHROW(open_sweep_folder(sweep));
  std::ofstream(sweep.inputs() / "paper_sedan.tir", std::ios::app) << "$ not even here?\n";
  CHECK_THROWS_WITH(open_sweep_folder(sweep), Contains("vehicle.tire.file: was SHA-256"));
}

TEST_CASE("A planning that was stopped before its end is done again", "[io]") {
  const TemporaryFolder folder;
  const std::string command = plan(folder, make_sweep_text(kFast));
  REQUIRE(run_program(command).code == 0);
  const auto before = read_all(folder / "sweep");
  const SweepFolder sweep{folder / "sweep"};
  fs::rename(sweep.plan(), sweep.plan().string() + ".a1B2c3");
  fs::remove(sweep.logs());
  std::ofstream(sweep.request()) << "half";
  CHECK_THROWS_WITH(open_sweep_folder(sweep), Contains("no plan.h5"));
  CHECK(run_program(command).code == 0);
  fs::remove(sweep.plan().string() + ".a1B2c3");
  CHECK(read_all(folder / "sweep") == before);
}

TEST_CASE("A folder with anything else in it is left alone", "[io]") {
  const TemporaryFolder folder;
  const std::string command = plan(folder, make_sweep_text(kFast));
  fs::create_directories(folder / "sweep");
  folder.write("sweep/thesis.tex", "mine");
  const Outcome outcome = run_program(command);
  CHECK(outcome.code == 2);
  CHECK_THAT(outcome.messages, Contains("thesis.tex") && Contains("new or empty folder"));
  CHECK(read_all(folder / "sweep").size() == 1);
  fs::remove_all(folder / "sweep");
  folder.write("sweep", "a file");
  CHECK(run_program(command).code == 2);
  // Shards without a plan are somebody's results.
  fs::remove(folder / "sweep");
  fs::create_directories(folder / "sweep/shards");
  folder.write("sweep/shards/000000.h5", "");
  CHECK(run_program(command).code == 2);
}

TEST_CASE("A damaged plan is named", "[io]") {
  const TemporaryFolder folder;
  const std::string command = plan(folder, make_sweep_text(kFast));
  REQUIRE(run_program(command).code == 0);
  folder.write("sweep/plan.h5", "no HDF5");
  const Outcome outcome = run_program(command);
  CHECK(outcome.code == 2);
  CHECK_THAT(outcome.messages, Contains("plan.h5"));
}

TEST_CASE("Two inputs of one name are both kept", "[io]") {
  const TemporaryFolder folder;
  fs::create_directories(folder / "a");
  fs::create_directories(folder / "b");
  std::string sedan = read_text(test::kExampleFolder + "vehicles/paper_sedan.toml");
  sedan.replace(sedan.find("../tires/"), 3, test::kExampleFolder);
  folder.write("a/same.toml", sedan);
  folder.write("b/same.toml", read_text(test::kExampleFolder + "maneuvers/bump_20mps.toml"));
  Replacements names = kFast;
  names.insert(names.end(),
               {{test::kExampleFolder + "vehicles/paper_sedan.toml", folder / "a/same.toml"},
                {test::kExampleFolder + "maneuvers/bump_20mps.toml", folder / "b/same.toml"}});
  REQUIRE(run_program(plan(folder, make_sweep_text(names))).code == 0);
  CHECK(fs::exists(folder / "sweep/request/same.toml"));
  CHECK(fs::exists(folder / "sweep/request/same_2.toml"));
}

TEST_CASE("What cannot be planned is refused with what can", "[io]") {
  check_plan_refused(make_sweep_text({{"rear_damping ", "rear_dampning "}}),
                     {":11: grid.rear_dampning", "unknown parameter", "'rear_damping'"});
  check_plan_refused(make_sweep_text({{"step = -500", "step = 500"}}),
                     {":8: grid.front_stiffness.step = 500", "must be < 0"});
  check_plan_refused(make_sweep_text({{"\"all\"", "20000"}}),
                     {"sample.count = 20000", "[1, 10000]"});
  check_plan_refused(make_sweep_text({{"strata = 10", "strata = 12"}}),
                     {"sample.strata = 12", "empty", "1 to 10"});
  check_plan_refused(make_sweep_text({{"to = 35500", "to = 35700"}}), {"36000", "35500"});
  check_plan_refused(make_sweep_text({{"to = 1800", "to = -20"}}),
                     {"grid.front_damping.to = -20", "[0, "});
  check_plan_refused(make_sweep_text({{"\"pitch_angle\"", "\"pitch_angel\""}}),
                     {"unknown channel 'pitch_angel'", "did you mean 'pitch_angle'"});
  check_plan_refused(
      make_sweep_text({{"method  = \"rk4\"", "method = \"abm4\""}, {"1e-3", "1.9e-2"}}),
      {"integrate.step = 0.019 s", "unstable", "must lie in (0, "});
  check_plan_refused("vehicle = \n", {":1: ", "not valid TOML"});
}

TEST_CASE("A sweep that nobody's car survives is refused with the car's file", "[io]") {
  const TemporaryFolder folder;
  std::string sedan = read_text(test::kExampleFolder + "vehicles/paper_sedan.toml");
  sedan.replace(sedan.find("../tires/"), 3, test::kExampleFolder);
  sedan.replace(sedan.find("mass = 1155"), 11, "mass = 250.");
  const auto car = folder.write("light.toml", sedan);
  const std::string text =
      make_sweep_text({{test::kExampleFolder + "vehicles/paper_sedan.toml", car.string()}});
  const Outcome outcome = run_program(plan(folder, text));
  CHECK(outcome.code == 2);
  CHECK_THAT(outcome.messages, Contains("light.toml"));
}

TEST_CASE("Cases that never meet the snapshot's line are warned of", "[io]") {
  const TemporaryFolder folder;
  Replacements far = kFast;
  far.emplace_back("offset = 0.0", "offset = 500");
  const Outcome outcome = run_program(plan(folder, make_sweep_text(far)) + " --dry-run");
  CHECK(outcome.code == 0);
  CHECK_THAT(outcome.messages, Contains("warning") && Contains("snapshot's line"));
}

TEST_CASE("Cases that fail are warned of before they run", "[io]") {
  const TemporaryFolder folder;
  const fs::path file = folder.write("failing.toml", test::make_failing_sweep());
  const Outcome outcome = run_program("plan " + file.string() + " --dry-run");
  CHECK(outcome.code == 0);
  CHECK_THAT(outcome.messages,
             Contains("failures among 8 cases simulated: 4; the first is case ") &&
                 Contains("the end of bump_ramp is impossible; case 2 with"));
  const Outcome good = run_program(plan(folder, make_sweep_text(kFast)) + " --dry-run");
  CHECK_THAT(good.messages, !Contains("warning"));
}

TEST_CASE("A row's snapshot is on its last bump, and without a bump plan warns", "[io]") {
  const TemporaryFolder folder;
  const auto write = [&](const std::string& maneuver, const std::string& axis) {
    const std::string examples = STRUT_SOURCE_DIR "/examples/";
    folder.write("sweep.toml",
                 "vehicle = \"" + examples + "vehicles/paper_sedan.toml\"\nmaneuver = \"" +
                     examples + "maneuvers/" + maneuver + ".toml\"\n[grid]\n" + axis +
                     "\n[integrate]\nmethod = \"rk4\"\nstep = 1e-3\nclosure = \"table\"\n"
                     "[record]\nsnapshot = { when = \"rear_wheels_on_bump\", channels = "
                     "[\"body_position_z\"] }\n");
    return "plan " + (folder / "sweep.toml").string() + " -o ";
  };
  const std::string rows = (folder / "rows").string();
  const Outcome planned = run_program(
      write("three_bumps", "bump_spacing = { from = 3.0, to = 6.0, step = 1.0 }") + rows);
  CHECK(planned.code == 0);
  CHECK_THAT(planned.messages, !Contains("no bump"));
  REQUIRE(run_program("run " + rows).code == 0);
  const std::string merged = (folder / "rows.h5").string();
  REQUIRE(run_program("merge " + rows + " -o " + merged).code == 0);
  const std::vector<double> heights = Hdf5Reader(merged).read("/snapshot").values;
  REQUIRE(heights.size() == 4);
  for (std::size_t i = 1; i < 4; ++i) CHECK(heights[i] != heights[0]);

  const Outcome rough =
      run_program(write("rough_road", "speed = { from = 15.0, to = 20.0, step = 5.0 }") +
                  (folder / "rough").string());
  CHECK(rough.code == 0);
  CHECK_THAT(rough.messages, Contains("no bump") && Contains("record.history"));
}

TEST_CASE("The call itself is checked", "[io]") {
  CHECK(run_program("plan").code == 2);
  CHECK_THAT(run_program("plan").messages, Contains("expected SWEEP.toml"));
  const TemporaryFolder folder;
  const auto file = folder.write("sweep.toml", make_sweep_text());
  CHECK_THAT(run_program("plan " + file.string()).messages, Contains("--output"));
  CHECK_THAT(run_program("plan nowhere.toml --dry-run").messages, Contains("nowhere.toml"));
  CHECK(run_program("plan " + file.string() + " -o /proc/sweep").code == 3);
}

TEST_CASE("Every example sweep plans", "[io]") {
  for (const char* name : {"paper", "paper_fast", "stratified_2000", "window_2000"}) {
    const Outcome outcome =
        run_program("plan " + test::kExampleFolder + "sweeps/" + name + ".toml --dry-run");
    INFO(name << ": " << outcome.messages);
    CHECK(outcome.code == 0);
    CHECK_THAT(outcome.messages, Catch::Matchers::StartsWith("next: strut plan "));
  }
}

}  // namespace
}  // namespace strut
