// strut init: what it writes is what the examples are, and stands on its own.
#include <catch2/catch.hpp>
#include <filesystem>

#include "tests/jobs/run_program.h"
#include "tests/support/temporary_folder.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
namespace fs = std::filesystem;

TEST_CASE("init writes a car, a maneuver and a sweep that run", "[io]") {
  const test::TemporaryFolder folder;
  const std::string own = (folder / "own").string(), run = (folder / "run.csv").string(),
                    example = (folder / "example.csv").string();
  const test::Outcome outcome = test::run_program("init " + own);
  INFO(outcome.messages);
  REQUIRE(outcome.code == 0);
  CHECK_THAT(outcome.out, Contains(own + "/vehicle.toml") && Contains(own + "/tire.tir"));
  REQUIRE(test::run_program("simulate " + own + "/vehicle.toml " + own + "/maneuver.toml -o " + run)
              .code == 0);
  const std::string examples = STRUT_SOURCE_DIR "/examples/";
  REQUIRE(test::run_program("simulate " + examples + "vehicles/paper_sedan.toml " + examples +
                            "maneuvers/bump_20mps.toml -o " + example)
              .code == 0);
  CHECK(test::read_text(run) == test::read_text(example));
  CHECK(test::run_program("plan " + own + "/sweep.toml --dry-run").code == 0);

  fs::remove(folder / "own/tire.tir");
  const test::Outcome again = test::run_program("init " + own);
  CHECK(again.code == 2);
  CHECK_THAT(again.messages, Contains("vehicle.toml") && Contains("--force"));
  CHECK_FALSE(fs::exists(folder / "own/tire.tir"));
  CHECK(test::run_program("init " + own + " --force").code == 0);
  CHECK(fs::exists(folder / "own/tire.tir"));
  CHECK(test::run_program("init").code == 2);
}

}  // namespace
}  // namespace strut
