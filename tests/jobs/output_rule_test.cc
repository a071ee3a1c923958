// The one rule for every file that a command writes.
#include <catch2/catch.hpp>
#include <map>

#include "jobs/cli/output_file.h"
#include "tests/jobs/run_program.h"

namespace strut {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;
using test::Outcome;
using test::read_text;
using test::run_program;
using test::TemporaryFolder;

const std::string kExamples = STRUT_SOURCE_DIR "/examples/";
const std::string kRun =
    kExamples + "vehicles/paper_sedan.toml " + kExamples + "maneuvers/bump_20mps.toml ";

std::map<std::string, std::string> read_all(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    files[entry.path()] = entry.is_regular_file() ? read_text(entry.path()) : "";
  }
  return files;
}

TEST_CASE("No command replaces what a sweep is made of, however it is told to", "[io]") {
  const TemporaryFolder folder;
  const std::string cars = folder / "cars", model = folder / "m.h5";
  REQUIRE(run_program("plan -q " + kExamples + "api/small_sweep.toml -o " + cars).code == 0);
  REQUIRE(run_program("run -q " + cars).code == 0);
  const std::string train = "train -q --allow-few --hidden 3 --epochs 1 " + cars;
  REQUIRE(run_program(train + " -o " + model).code == 0);
  fs::create_directory(folder / "cars/jobs");
  fs::create_directory_symlink(folder / "cars", folder / "link");
  fs::create_symlink(folder / "cars/shards/000000.h5", folder / "shard.h5");
  fs::create_symlink(folder / "cars/plan.h5", folder / "curves.csv");
  const auto before = read_all(cars);
  const std::string commands[] = {
      "merge --force " + cars + " -o ",
      train + " --force -o ",
      train + " --force -o " + model + " --checkpoint ",
      train + " -o " + model + "2 --resume --checkpoint ",
      "simulate --force " + kRun + " -o ",
      "export --force " + model + " -o ",
      "design --force " + kExamples + "api/small_sweep.toml --csv ",
      "simulate " + kRun + " -o " + std::string(folder / "r.csv") + " --report ",
      "compare --force " + kExamples + "extended_loop/campaign.toml -o ",
      "diagnose --force " + kExamples + "extended_loop/campaign.toml -o ",
      "plan " + kExamples + "api/small_sweep.toml -o ",
      "study " + kExamples + "studies/paper_quick.toml -o "};
  for (const std::string& command : commands) {
    for (const char* place :
         {"cars/plan.h5", "cars/request.toml", "cars/journal", "cars/shards/000000.h5",
          "cars/shards/new.h5", "cars/retries/a.h5", "cars/claims/a.csv", "cars/tmp/a.csv",
          "cars/quarantine/a.h5", "cars/logs/a.h5", "cars/request/a.csv", "cars/jobs/a.h5",
          "link/plan.h5", "link/shards/a.h5", "shard.h5", "curves.csv", "cars/../cars/plan.h5"}) {
      INFO(command << place);
      const Outcome outcome = run_program(command + std::string(folder / place));
      INFO(outcome.messages);
      CHECK(outcome.code == 2);
    }
  }
  CHECK(read_all(cars) == before);
  CHECK_FALSE(fs::exists(folder / "r.csv"));
  // A file beside them is nobody's.
  CHECK(run_program("merge -q " + cars + " -o " + cars + "/all.h5").code == 0);
}

TEST_CASE("A file that exists is replaced with --force alone, by every command", "[io]") {
  const TemporaryFolder folder;
  const std::string cars = folder / "cars", model = folder / "m.h5";
  REQUIRE(run_program("plan -q " + kExamples + "api/small_sweep.toml -o " + cars).code == 0);
  REQUIRE(run_program("run -q " + cars).code == 0);
  const std::string train = "train -q --allow-few --hidden 3 --epochs 1 " + cars;
  REQUIRE(run_program(train + " -o " + model).code == 0);
  const std::pair<std::string, const char*> cases[] = {
      {"simulate " + kRun + "-o ", "a.csv"},
      {"simulate " + kRun + "-o ", "a.h5"},
      {"simulate --kinematics " + kExamples + "vehicles/paper_sedan.toml -o ", "b.csv"},
      {"simulate " + kExamples + "rigs/quarter_car.toml " + kExamples +
           "rigs/maneuvers/bump.toml -o ",
       "c.csv"},
      {"merge " + cars + " -o ", "d.h5"},
      {train + " -o ", "e.h5"},
      {train + " -o " + std::string(folder / "f.h5") + " --checkpoint ", "checkpoint"},
      {"export " + model + " -o ", "g.onnx"},
      {"design " + kExamples + "api/small_sweep.toml --rate 100 --csv ", "h.csv"}};
  for (const auto& [command, name] : cases) {
    const std::string file = folder.write(name, "mine");
    INFO(command << file);
    const Outcome refused = run_program(command + file);
    CHECK(refused.code == 2);
    CHECK_THAT(refused.messages, Contains(file + ": exists; ") && Contains("--force replaces it"));
    CHECK(read_text(file) == "mine");
    CHECK(run_program(command + file + " --force").code == 0);
    CHECK(read_text(file) != "mine");
  }
}

TEST_CASE("Devices and pipes are no output", "[io]") {
  const TemporaryFolder folder;
  REQUIRE(test::run_shell("mkfifo " + std::string(folder / "pipe.csv")).code == 0);
  for (const std::string& file : {std::string("/dev/null"), std::string(folder / "pipe.csv")}) {
    CHECK_THROWS_WITH(check_output_file("output", file, {}, true),
                      "--output = " + file + ": not a regular file; name another file");
  }
}

}  // namespace
}  // namespace strut
