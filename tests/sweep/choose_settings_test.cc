// The settings that a sweep file leaves open: integrator and shards.
#include "sweep/choose_settings.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "sweep/facts.h"
#include "sweep/folder.h"
#include "sweep/simulate_cases.h"
#include "tests/support/sweep_text.h"
#include "tests/support/test_sweep.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::SweepText;

const std::atomic<bool> kGoOn{false};

SweepText make_open(const std::string& integrate = "") {
  SweepText text;
  text.grid =
      "mass = { from = 900, to = 1300, count = 6 }\n"
      "tire_stiffness = { from = 180e3, to = 240e3, count = 6 }\n";
  text.sample = "strata = 3\n";
  text.integrate = integrate;
  return text;
}

SweepRequest read(const SweepText& text) {
  const test::TemporaryFolder folder;
  return read_request(test::write_sweep(folder, text));
}

ShardRows simulate(const SweepRequest& request, const std::vector<std::int64_t>& ids) {
  const Plan plan(request);
  ShardRows rows = ShardRows::make(plan.make_schema(), ids.size());
  CaseSimulator simulator(plan, list_kernels().front());
  REQUIRE(simulator.simulate(ids, rows, 0, kGoOn));
  return rows;
}

/// Range of a channel over a run of the base car, from its history.
double calc_range(const SweepRequest& request, int channel) {
  const LaneResults run = list_kernels().back().run_scalar(CasePreparer().prepare(request.base), {},
                                                           SamplePlan{.interval = 5e-3});
  const std::vector<double> values = run.get_history(channel);
  return *std::max_element(values.begin(), values.end()) -
         *std::min_element(values.begin(), values.end());
}

TEST_CASE("An open integrator keeps its bound, also on cases that it was not chosen by",
          "[unit][reference]") {
  SweepRequest request = read(make_open());
  CHECK(request.accuracy == 1e-3);
  const auto choice = choose_settings(request);
  REQUIRE(choice);
  CHECK(choice->cases == 8);
  CHECK(choice->error <= 1e-3);
  CHECK(choice->error > 0.0);
  CHECK(request.integrate.options.closure == Closure::kTable);
  CHECK(request.integrate.options.step.coarse_step > request.integrate.options.step.step);

  // Cases that the choice has not seen, against CVODE.
  const std::vector<std::int64_t> others = {2, 9, 16, 23, 27, 34};
  SweepRequest exact = request;
  exact.integrate.solver = Solver::kCvode;
  exact.integrate.reference.closure = Closure::kNewton;
  const ShardRows rows = simulate(request, others), truth = simulate(exact, others);
  const std::vector<int>& channels = request.snapshot.channels;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const double range = calc_range(request, channels[c]);
    for (std::size_t row = 0; row < others.size(); ++row) {
      CAPTURE(channels[c], others[row]);
      const std::size_t at = row * channels.size() + c;
      CHECK(std::fabs(rows.snapshot[at] - truth.snapshot[at]) < 1.5e-3 * range);
    }
  }

  SweepRequest tight = read(make_open("accuracy = 1e-5\n"));
  const auto tight_choice = choose_settings(tight);
  REQUIRE(tight_choice);
  CHECK(tight_choice->error <= 1e-5);
  CHECK(tight_choice->error < choice->error);
  CHECK(tight.integrate.options.step.step < request.integrate.options.step.step);
}

TEST_CASE("What the file names is not chosen", "[unit]") {
  SweepRequest given = read(make_open("method = \"rk4\"\n"));
  CHECK(given.accuracy == 0.0);
  CHECK_FALSE(choose_settings(given));
  CHECK(given.integrate.options.closure == Closure::kNewton);
  CHECK(given.integrate.options.step.step == 1e-3);
  CHECK(given.integrate.options.symmetry);
  CHECK_FALSE(read(make_open("symmetry = false\n")).integrate.options.symmetry);
  CHECK(read(make_open("symmetry = false\n")).accuracy == 1e-3);

  CHECK_THROWS_WITH(read(make_open("accuracy = 1e-4\nstep = 1e-3\n")),
                    Contains("integrate.step") && Contains("beside accuracy"));
  CHECK_THROWS_WITH(read(make_open("accuracy = 1e-12\n")),
                    Contains("integrate.accuracy") && Contains("1e-07"));
  CHECK_THROWS_WITH(read(make_open("accuracy = \"high\"\n")), Contains("integrate.accuracy"));
}

TEST_CASE("A folder keeps the settings that its plan chose", "[unit]") {
  const test::TemporaryFolder files;
  const auto file = test::write_sweep(files, make_open());
  const Plan plan = make_plan(file);
  const SweepFolder folder = make_sweep_folder(files / "sweep", plan);
  const Plan opened = open_sweep_folder(folder);
  CHECK(opened.hash() == plan.hash());
  CHECK(opened.request().integrate.options.step == plan.request().integrate.options.step);
  CHECK(opened.request().integrate.options.closure == Closure::kTable);
  // The same file again, as it is read before any choice.
  CHECK_NOTHROW(make_sweep_folder(files / "sweep", Plan(read_request(file))));

  // The settings given by name yield the same numbers.
  const StepOptions& step = plan.request().integrate.options.step;
  SweepText named =
      make_open("method = \"" + std::string(step.stepper == Stepper::kAbm4 ? "abm4" : "rk4") +
                "\"\nclosure = \"table\"\nstep = " + std::to_string(step.step) +
                "\ncoarse_step = " + std::to_string(step.coarse_step) + "\n");
  const std::vector<std::int64_t> ids = {0, 7, 35};
  CHECK(simulate(read(named), ids).snapshot == simulate(opened.request(), ids).snapshot);
}

TEST_CASE("Settings in the facts that no plan chooses are refused", "[unit]") {
  const Facts chosen = Plan(read(make_open())).facts();
  const auto adopt = [&](const std::string& name, const std::string& value) {
    Facts facts = chosen;
    for (auto& [key, text] : facts) {
      if (key == name) text = value;
    }
    SweepRequest request = read(make_open());
    request.chooses_shards = true;
    adopt_settings(facts, request);
  };
  CHECK_NOTHROW(adopt("integrate.step", "0.0005"));
  for (const char* step : {"0", "nan", "1e-300", "-1", "1", "", "fast"}) {
    CAPTURE(step);
    CHECK_THROWS_WITH(adopt("integrate.step", step), Contains("integrate.step"));
  }
  for (const char* cases : {"0", "-8", "1e300", "nan", "100000", ""}) {
    CAPTURE(cases);
    CHECK_THROWS_WITH(adopt("shards.cases", cases), Contains("shards.cases"));
  }
  CHECK_THROWS_WITH(adopt("integrate.method", "cvode"), Contains("integrate.method"));
  CHECK_THROWS_WITH(adopt("integrate.closure", "none"), Contains("integrate.closure"));
  CHECK_THROWS_WITH(adopt("integrate.coarse_step", "1e-9"), Contains("integrate.coarse_step"));
}

TEST_CASE("A batch of mixed durations and sensors gives each case its own row",
          "[unit][property]") {
  SweepText text = make_open("method = \"abm4\"\nclosure = \"table\"\n");
  text.grid =
      "duration = { from = 0.7, to = 0.9, count = 2 }\n"
      "body_position_z_sensor_delay = { from = 0, to = 0.004, count = 2 }\n";
  text.sample = "strata = 2\n";
  const SweepRequest request = read(text);
  const ShardRows together = simulate(request, {0, 1, 2, 3});
  for (const std::int64_t id : {0, 1, 2, 3}) {
    CAPTURE(id);
    const ShardRows alone = simulate(request, {id});
    REQUIRE(alone.status[0] == 0);
    const std::size_t count = alone.snapshot.size();
    for (std::size_t i = 0; i < count; ++i) {
      REQUIRE(std::isfinite(alone.snapshot[i]));
      CHECK(together.snapshot[static_cast<std::size_t>(id) * count + i] == alone.snapshot[i]);
    }
  }
}

TEST_CASE("A sweep none of whose cases runs keeps the default integrator", "[unit]") {
  SweepText text = make_open();
  text.grid = "rear_stiffness = { from = 2000, to = 2100, count = 3 }\n";  // cannot carry the car
  SweepRequest request = read(text);
  const auto choice = choose_settings(request);
  REQUIRE(choice);
  CHECK(choice->cases == 0);
  CHECK(request.integrate.options.closure == Closure::kNewton);
}

TEST_CASE("A shard is some seconds of work, whatever a case costs", "[unit]") {
  const auto choose = [](const std::string& integrate) {
    std::string text = test::make_sweep_text({{"\ncases = 512", "\n"}});
    const std::size_t begin = text.find("[integrate]"), end = text.find("[record]");
    text.replace(begin, end - begin, "[integrate]\n" + integrate + "\n");
    SweepRequest request = test::read_sweep_text(text);
    REQUIRE(request.chooses_shards);
    choose_settings(request);
    return request.shard_cases;
  };
  CHECK(choose("method = \"rk4\"") == 512);
  const int slow = choose("method = \"rk4\"\nstep = 1e-5");
  const int slower = choose("method = \"rk4\"\nstep = 2e-6");
  CHECK(slow < 128);
  CHECK(slow % 8 == 0);
  CHECK(slower == 8);
  CHECK(choose("method = \"cvode\"") < 64);
}

}  // namespace
}  // namespace strut
