// A file in another's place is named as what it is.
#include <catch2/catch.hpp>

#include "tests/jobs/run_program.h"
#include "tests/support/temporary_folder.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;

const std::string kExamples = STRUT_SOURCE_DIR "/examples/";

TEST_CASE("A file in another's place is named as what it is", "[io]") {
  struct Swap {
    std::string command, told;
  };
  const std::string car = kExamples + "vehicles/paper_sedan.toml ",
                    bump = kExamples + "maneuvers/bump_20mps.toml ",
                    rig = kExamples + "rigs/quarter_car.toml ",
                    sweep = kExamples + "sweeps/paper.toml ",
                    campaign = kExamples + "extended_loop/campaign.toml ",
                    study = kExamples + "studies/paper.toml ";
  const std::vector<Swap> swaps = {
      {"simulate " + bump + car, "bump_20mps.toml: a maneuver of a car; must be a vehicle or rig"},
      {"simulate " + car + car, "paper_sedan.toml: a vehicle or rig; must be a maneuver of a car"},
      {"simulate " + car + sweep, "paper.toml: a sweep; must be a maneuver of a car"},
      {"simulate " + rig + bump,
       "bump_20mps.toml: a maneuver of a car; must be a maneuver of a rig"},
      {"simulate " + campaign + bump, "campaign.toml: a campaign; must be a vehicle or rig"},
      {"plan " + campaign, "campaign.toml: a campaign; must be a sweep"},
      {"plan " + car, "paper_sedan.toml: a vehicle or rig; must be a sweep"},
      {"compare " + sweep, "paper.toml: a sweep; must be a campaign"},
      {"diagnose " + study, "paper.toml: a study; must be a campaign"},
      {"study " + sweep, "paper.toml: a sweep; must be a study"},
  };
  const test::TemporaryFolder folder;
  const std::string out = (folder / "out").string();
  for (const Swap& swap : swaps) {
    const bool is_file = swap.command.starts_with("simulate");
    const test::Outcome outcome =
        test::run_program(swap.command + " -o " + out + (is_file ? ".csv" : ""));
    INFO(swap.command << "\n" << outcome.messages);
    CHECK(outcome.code == 2);
    CHECK_THAT(outcome.messages, Contains(swap.told));
  }
}

TEST_CASE("Results never replace a vehicle, maneuver, sweep or tire", "[io]") {
  const test::TemporaryFolder folder;
  const std::string car = folder.write("car.toml", "type = 1");
  const std::string tire = folder.write("tire.tir", "[TIRE]");
  const std::string sweep = (folder / "sweep").string();
  REQUIRE(test::run_program("plan " + kExamples + "sweeps/stratified_2000.toml -o " + sweep).code ==
          0);
  for (const std::string& command :
       {"merge " + sweep + " --force -o " + car, "merge " + sweep + " --force -o " + tire,
        "train " + sweep + " --force -o " + car}) {
    const test::Outcome outcome = test::run_program(command);
    INFO(command << "\n" << outcome.messages);
    CHECK(outcome.code == 2);
    CHECK_THAT(outcome.messages, Contains("must be another, as FILE.h5"));
  }
  CHECK(test::read_text(car) == "type = 1");
}

TEST_CASE("The option --force replaces a result of the same kind, and of no other", "[io]") {
  const test::TemporaryFolder folder;
  const std::string sweep = (folder / "sweep").string(), merged = (folder / "cars.h5").string(),
                    model = (folder / "model.h5").string();
  const auto run = [](const std::string& command) { return test::run_program(command); };
  REQUIRE(run("plan " + kExamples + "api/small_sweep.toml -o " + sweep).code == 0);
  REQUIRE(run("run " + sweep).code == 0);
  REQUIRE(run("merge " + sweep + " -o " + merged).code == 0);
  const std::string train = "train " + sweep + " --hidden 3 --epochs 2 -o ";
  REQUIRE(run(train + model).code == 0);
  const std::string bytes = test::read_text(model);
  const std::string simulate = "simulate " + kExamples + "vehicles/paper_sedan.toml " + kExamples +
                               "maneuvers/bump_20mps.toml --force -o ";
  for (const std::string& command : {simulate + model, "merge " + sweep + " --force -o " + model}) {
    const test::Outcome outcome = run(command);
    INFO(command << "\n" << outcome.messages);
    CHECK(outcome.code == 2);
    CHECK_THAT(outcome.messages, Contains("which this command does not write"));
  }
  CHECK(test::read_text(model) == bytes);
  CHECK(run(train + model + " --force").code == 0);
  CHECK(run("merge " + sweep + " --force -o " + merged).code == 0);
}

}  // namespace
}  // namespace strut
