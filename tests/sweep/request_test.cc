// Sweep files are read as written; invalid ones are refused with what is allowed.
#include "sweep/request.h"

#include <catch2/catch.hpp>

#include "tests/support/sweep_text.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::make_grid_text;
using test::make_sweep_text;
using test::read_sweep_text;
using test::Replacements;

TEST_CASE("The paper's sweep file reads as the paper's sweep", "[unit][io]") {
  const SweepRequest request = read_sweep_text(make_sweep_text());
  const auto& axes = request.grid.axes();
  REQUIRE(axes.size() == 4);
  CHECK(axes[0].name == "front_stiffness");
  CHECK(axes[1].name == "front_damping");
  CHECK(axes[2].name == "rear_stiffness");
  CHECK(axes[3].name == "rear_damping");
  for (const Axis& axis : axes) CHECK(axis.count == 10);
  CHECK(axes[0].last() == 35500.0);
  CHECK(axes[1].last() == 1800.0);
  CHECK(axes[2].last() == 30500.0);
  CHECK(request.grid.size() == 10000);
  CHECK(request.sample.method == SampleMethod::kGrid);
  CHECK(request.sample.strata == 10);
  CHECK(request.sample.by == "front_stiffness");
  CHECK(request.sample.count == -1);
  CHECK(request.sample.seed == 1);
  CHECK(request.integrate.solver == Solver::kLanes);
  CHECK(request.integrate.options.step.stepper == Stepper::kRk4);
  CHECK(request.integrate.options.step.step == 1e-3);
  CHECK(request.integrate.options.closure == Closure::kNewton);
  CHECK(request.snapshot.on);
  CHECK(request.snapshot.channels == std::vector<int>{1, 2, 3, 4, 5});
  CHECK(request.history.rate == 0.0);
  CHECK(request.shard_cases == 512);
  CHECK(request.shuffle);
  CHECK(request.base.maneuver.speed == 20.0);
  const SamplePlan samples = make_sample_plan(request);
  CHECK(samples.snapshot);
  CHECK(count_samples(samples) == 0);
}

const std::pair<std::string, std::string> kByFirstAxis = {"by     = \"front_stiffness\"", ""},
                                          kAllStrata = {"strata = 10", "strata = 1"};

TEST_CASE("The default step of a sweep resolves the effects of all its cases", "[unit]") {
  const Replacements no_step = {kByFirstAxis, kAllStrata, {"step    = 1e-3", ""}};
  const auto find_default = [&](const std::string& axes) {
    return read_sweep_text(make_grid_text(axes, no_step)).integrate.options.step.step;
  };
  CHECK(find_default("rear_stiffness = { from = 40000, to = 35500, step = -500 }") == 1e-3);
  CHECK(find_default("rear_joint_play = { from = 2e-3, to = 1e-2, count = 3 }") == 1e-3);
  // The contact time of the smallest play is 0.2 ms.
  CHECK(find_default("rear_joint_play = { from = 1e-2, to = 1e-4, count = 3 }") == 1.25e-4);
  // 2000 N over 5 mm/s on a wheel of some 40 kg: 0.1 ms, where both ends meet.
  CHECK(find_default("front_strut_friction_speed = { from = 5e-3, to = 0.1, count = 3 }\n"
                     "front_strut_friction_force = { from = 0, to = 2000, count = 3 }") < 2e-4);
}

TEST_CASE("A step that is given stays, and the longest one is known", "[unit]") {
  const SweepRequest request = read_sweep_text(make_grid_text(
      "rear_joint_play = { from = 1e-2, to = 1e-4, count = 3 }", {kByFirstAxis, kAllStrata}));
  CHECK(request.integrate.options.step.step == 1e-3);
  CHECK(find_longest_step(request) < 2.5e-4);
}

TEST_CASE("Keys that a sweep file leaves out have their defaults", "[unit][io]") {
  const std::string text = make_sweep_text();
  const std::size_t begin = text.find("[sample]"), end = text.find("[record]");
  std::string shorter = text.substr(0, begin) + text.substr(end);
  shorter.resize(shorter.find("[shards]"));
  const SweepRequest request = read_sweep_text(shorter);
  CHECK(request.sample.by == "front_stiffness");
  CHECK(request.sample.strata == 10);
  CHECK(request.sample.count == -1);
  CHECK(request.integrate.options.step.step == 1e-3);
  CHECK(request.shard_cases == 512);
}

TEST_CASE("Every way to integrate is read", "[unit][io]") {
  const auto read = [](const std::string& keys) {
    return read_sweep_text(make_sweep_text({{"method  = \"rk4\"", keys}})).integrate;
  };
  const SolverOptions abm4 = read("method = \"abm4\"\ncoarse_step = 0.006\nlocate_events = false");
  CHECK(abm4.options.step.stepper == Stepper::kAbm4);
  CHECK(abm4.options.step.coarse_step == 0.006);
  CHECK_FALSE(abm4.options.step.locate_events);
  const SolverOptions cvode = read_sweep_text(make_sweep_text({{"\"rk4\"", "\"cvode\""},
                                                               {"step    = 1e-3", ""},
                                                               {"\"newton\"", "\"table\""}}))
                                  .integrate;
  CHECK(cvode.solver == Solver::kCvode);
  CHECK(cvode.reference.closure == Closure::kTable);
}

TEST_CASE("A history is sampled over the whole run, with or without a snapshot", "[unit][io]") {
  const Replacements history = {
      {"[shards]", "history = { rate = 200, channels = [\"pitch_rate\", \"time\"] }\n[shards]"}};
  SweepRequest request = read_sweep_text(make_sweep_text(history));
  CHECK(request.history.rate == 200.0);
  CHECK(request.history.channels == std::vector<int>{5, 0});
  CHECK(count_samples(make_sample_plan(request)) == 601);
  std::string text = make_sweep_text(history);
  const std::size_t begin = text.find("snapshot = {"), end = text.find("history = {");
  request = read_sweep_text(text.substr(0, begin) + text.substr(end));
  CHECK_FALSE(request.snapshot.on);
  CHECK_FALSE(make_sample_plan(request).snapshot);
}

TEST_CASE("An axis given by its number of levels equals the one given by its step", "[unit][io]") {
  const SweepRequest request =
      read_sweep_text(make_grid_text("front_stiffness = { from = 40000, to = 35500, count = 10 }\n"
                                     "speed = { from = 20, to = 20, count = 1 }",
                                     {}));
  CHECK(request.grid.axes()[0].step == -500.0);
  CHECK(request.grid.axes()[0].count == 10);
  CHECK(request.grid.axes()[1].count == 1);
}

TEST_CASE("Samples between the bounds need no levels", "[unit][io]") {
  const SweepRequest request =
      read_sweep_text(make_grid_text("front_stiffness = { from = 40000, to = 35500 }",
                                     {{"\"grid\"", "\"sobol\""}, {"\"all\"", "64"}}));
  CHECK(request.sample.method == SampleMethod::kSobol);
  CHECK(request.grid.axes()[0].from == 40000.0);
  CHECK(request.grid.axes()[0].last() == 35500.0);
  CHECK_FALSE(request.shuffle);
}

TEST_CASE("A grid runs shuffled unless an axis changes the mechanism", "[unit]") {
  const auto read = [](const std::string& axis) {
    return read_sweep_text(make_grid_text(axis, {{"by     = \"front_stiffness\"", ""}})).shuffle;
  };
  CHECK(read("front_stiffness = { from = 40000, to = 35500, step = -500 }"));
  CHECK(read("speed = { from = 18, to = 22, count = 10 }"));
  CHECK(read("drive_torque = { from = 400, to = 600, count = 10 }"));
  CHECK_FALSE(read("mass = { from = 1100, to = 1200, count = 10 }"));
  CHECK_FALSE(read("bump_height = { from = 0.04, to = 0.06, count = 11 }"));
  CHECK_FALSE(read("duration = { from = 2.0, to = 3.0, count = 10 }"));
}

/// A replacement in the paper's file, and what the message must contain.
struct BadInput {
  std::string from, to;
  std::vector<std::string> message;
};

TEST_CASE("An invalid value is reported with file, line, key and what is allowed", "[unit][io]") {
  const std::string axis = "front_stiffness = { from = 40000, to = 35500, step = -500 }";
  const std::string snapshot = "offset = 0.0, channels = [\"body_position_z\", ";
  const BadInput inputs[] = {
      {"front_stiffness = {",
       "front_stifness = {",
       {"grid.front_stifness", "unknown parameter", "did you mean 'front_stiffness'?",
        "parameters: mass"}},
      {axis,
       "front_stiffness = { from = 40000, to = 35500, step = 500 }",
       {"grid.front_stiffness.step = 500", "must be < 0"}},
      {axis, "front_stiffness = { from = 35500, to = 40000, step = -500 }", {"must be > 0"}},
      {axis,
       "front_stiffness = { from = 40000, to = 35500, step = 0 }",
       {"step = 0", "must be < 0"}},
      {axis,
       "front_stiffness = { from = 40000, to = 35600, step = -500 }",
       {"to = 35600", "not reached", "36000", "35500"}},
      {axis, "front_stiffness = { from = 40000, to = 35500, step = 1e-15 }", {"step = 1e-15"}},
      {axis, "front_stiffness = { from = 40000, to = 35500, step = -1e-15 }", {"too small"}},
      {axis,
       "front_stiffness = { from = 40000, to = 50, step = -50 }",
       {"to = 50", "must lie in [100, 1e+06] N/m"}},
      {axis,
       "front_stiffness = { from = 40000, to = 35500 }",
       {"missing key 'grid.front_stiffness.step'"}},
      {axis,
       "front_stiffness = { from = 40000, to = 35500, step = -500, count = 10 }",
       {"count = 10", "'step'"}},
      {axis,
       "front_stiffness = { from = 40000, to = 35500, count = 1 }",
       {"count = 1", "must lie in [2, "}},
      {axis,
       "front_stiffness = { from = 40000, to = 35500, stp = -500 }",
       {"step'; is 'stp' meant"}},
      {axis, "front_stiffness = [40000, 35500]", {"grid.front_stiffness", "must be a table"}},
      {axis, "front_stiffness = { from = nan, to = 35500, step = -500 }", {"from = nan"}},
      {axis,
       axis + "\nfront_left_stiffness = { from = 40000, to = 35500, step = -500 }",
       {"front_left_stiffness", "'front_stiffness'"}},
      {axis, axis + "\nbump_ramp = { from = 0, to = 0.1, step = 0.1 }", {"bump_ramp.from = 0"}},
      {"method = \"grid\"", "method = \"grit\"", {"sample.method", "did you mean 'grid'?"}},
      {"method = \"grid\"", "method = \"sobol\"", {"sample.count", "must be a number"}},
      {"strata = 10", "strata = 0", {"sample.strata = 0", "[1, "}},
      {"strata = 10", "strata = 2.5", {"sample.strata = 2.5", "whole number"}},
      {"by     = \"front_stiffness\"",
       "by     = \"speed\"",
       {"sample.by = \"speed\"", "front_damping", "degradation"}},
      {"count  = \"all\"", "count  = \"al\"", {"sample.count = \"al\"", "all"}},
      {"count  = \"all\"", "count  = 0", {"sample.count = 0", "[1, "}},
      {"seed   = 1", "seed   = -1", {"sample.seed = -1"}},
      {"method  = \"rk4\"", "method  = \"rk5\"", {"integrate.method", "rk4, abm4, cvode"}},
      {"method  = \"rk4\"", "method  = \"cvode\"", {"integrate.step", "rk4, abm4"}},
      {"step    = 1e-3", "step    = 0", {"integrate.step = 0", "(0, 0.02] s"}},
      {"step    = 1e-3", "step    = 1e-3\ncoarse_step = 5e-4", {"coarse_step", "[0.001, 0.02] s"}},
      {"step    = 1e-3", "step    = 1e-3\nlocate_events = 1", {"locate_events", "true or false"}},
      {"closure = \"newton\"", "closure = \"tables\"", {"did you mean 'table'?"}},
      {"rear_wheels_on_bump", "front_wheels", {"record.snapshot.when", "rear_wheels_on_bump"}},
      {snapshot,
       "offset = 0.0, channels = [\"body_positon_z\", ",
       {"unknown channel 'body_positon_z'", "did you mean 'body_position_z'?", "pitch_rate"}},
      {snapshot, "offset = 0.0, channels = [\"pitch_rate\", ", {"'pitch_rate' twice"}},
      {snapshot,
       "offset = 1e4, channels = [\"body_position_z\", ",
       {"record.snapshot.offset = 10000", "[-1000, 1000] m"}},
      {"[shards]",
       "history = { rate = 1e9, channels = [\"time\"] }\n[shards]",
       {"record.history.rate = 1", "1/s"}},
      {"[shards]",
       "history = { rate = 6000, channels = [\"time\"] }\n[shards]",
       {"shards.cases = 512", "[1, 444]"}},
      {"cases = 512", "cases = 0", {"shards.cases = 0", "[1, 65536]"}},
      {"[shards]", "[shard]", {"unknown key 'shard'", "did you mean 'shards'?"}},
      {"paper_sedan.toml", "paper_sedan2.toml", {"vehicle", "file not found"}},
      {"maneuver = ", "manoeuvre = ", {"missing key 'maneuver'"}},
      {"[record]", "[recording]", {"missing key 'record'"}},
  };
  const test::TemporaryFolder folder;
  for (const BadInput& input : inputs) {
    const auto file = folder.write("sweep.toml", make_sweep_text({{input.from, input.to}}));
    std::string message;
    try {
      read_request(file);
    } catch (const InputError& e) {
      message = e.what();
    }
    CAPTURE(input.to);
    CHECK_THAT(message, Contains("sweep.toml:"));
    for (const std::string& text : input.message) CHECK_THAT(message, Contains(text));
  }
}

TEST_CASE("A request needs an axis, something to record, and nonzero references for losses",
          "[unit][io]") {
  CHECK_THROWS_WITH(read_sweep_text(make_grid_text("", {{"by     = \"front_stiffness\"", ""}})),
                    Contains("[grid]") && Contains("no axis"));
  std::string text = make_sweep_text();
  const std::size_t begin = text.find("snapshot = {"), end = text.find("[shards]");
  CHECK_THROWS_WITH(read_sweep_text(text.substr(0, begin) + text.substr(end)),
                    Contains("[record]") && Contains("nothing to record"));
  CHECK_THROWS_WITH(
      read_sweep_text(make_grid_text("drive_torque = { from = 0, to = 500, step = 50 }",
                                     {{"by     = \"front_stiffness\"", "by = \"degradation\""}})),
      Contains("sample.by") && Contains("drive_torque"));
  CHECK_THROWS_WITH(
      read_sweep_text(make_grid_text("speed = { from = 20, to = 10, count = 4000000000 }\n"
                                     "mass = { from = 1000, to = 1100, count = 4000000000 }",
                                     {{"by     = \"front_stiffness\"", ""}})),
      Contains("[grid]") && Contains("points"));
}

TEST_CASE("A history requires that all cases have the same duration", "[unit][io]") {
  CHECK_THROWS_WITH(
      read_sweep_text(make_grid_text(
          "duration = { from = 2, to = 3, step = 0.1 }",
          {{"by     = \"front_stiffness\"", ""},
           {"[shards]", "history = { rate = 100, channels = [\"time\"] }\n[shards]"}})),
      Contains("record.history") && Contains("duration"));
}

}  // namespace
}  // namespace strut
