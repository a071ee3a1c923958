// `strut design`: its proposal for the paper's sweep, and its messages.
#include "estimate/design.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "io/table/csv.h"
#include "model_files/parameters.h"
#include "model_files/read_maneuver.h"
#include "model_files/read_vehicle.h"
#include "sweep/request.h"
#include "tests/jobs/parse_json.h"
#include "tests/jobs/run_program.h"
#include "tests/support/test_car.h"

namespace strut {
namespace {

using C = CarChannel;
using Catch::Matchers::Contains;
using test::Outcome;
using test::run_program;
using test::TemporaryFolder;
using test::tolerance;

const std::string kExamples = STRUT_SOURCE_DIR "/examples";
const std::vector<int> kInputs = {C::kBodyPositionZ, C::kBodyVelocityZ, C::kBodyAccelerationZ,
                                  C::kPitchAngle, C::kPitchRate};

SweepRequest make_request() {
  SweepRequest request;
  request.path = "paper.toml";
  request.base = {read_vehicle(kExamples + "/vehicles/paper_sedan.toml"),
                  read_maneuver(kExamples + "/maneuvers/bump_20mps.toml")};
  request.grid = Grid({{"front_stiffness", 40000.0, -500.0, 10},
                       {"front_damping", 1980.0, -20.0, 10},
                       {"rear_stiffness", 35000.0, -500.0, 10},
                       {"rear_damping", 1980.0, -20.0, 10}});
  request.snapshot.channels = kInputs;
  return request;
}

const Sensitivity& paper_sensitivity() {
  static const Sensitivity s = [] {
    const SweepRequest request = make_request();
    return calc_sensitivity(make_base_point(request.base, request.grid, {}, {}),
                            request.grid.axes(), 0.0, {});
  }();
  return s;
}

const Design& paper_design() {
  static const Design design = calc_design(paper_sensitivity(), kInputs, make_default_noise());
  return design;
}

TEST_CASE("The base point is the middle of the grid unless set otherwise", "[unit]") {
  const SweepRequest request = make_request();
  Case c = make_base_point(request.base, request.grid, {}, {});
  CHECK(get_parameter(c, "front_stiffness") == 37750.0);
  CHECK(get_parameter(c, "rear_damping") == 1890.0);
  c = make_base_point(request.base, request.grid, {"rear_damping=1850"},
                      {"speed=15", "front_stiffness=36000"});
  CHECK(get_parameter(c, "front_stiffness") == 36000.0);
  CHECK(get_parameter(c, "rear_damping") == 1850.0);
  CHECK(get_parameter(c, "speed") == 15.0);
  CHECK_THROWS_WITH(make_base_point(request.base, request.grid, {"rear_dampin=1850"}, {}),
                    Contains("did you mean 'rear_damping'?"));
  CHECK_THROWS_WITH(make_base_point(request.base, request.grid, {"speed=15"}, {}),
                    Contains("not an axis of this sweep"));
}

TEST_CASE("Sensor noise is set by name and must be positive", "[unit]") {
  SensorNoise noise = make_default_noise();
  apply_noise(noise, "pitch_rate=0.002");
  CHECK(noise[C::kPitchRate] == 0.002);
  CHECK_THROWS_WITH(apply_noise(noise, "pitch_rat=0.002"), Contains("did you mean 'pitch_rate'?"));
  CHECK_THROWS_WITH(apply_noise(noise, "pitch_rate=0"), Contains("must be > 0 rad/s"));
  CHECK_THROWS_AS(apply_noise(noise, "pitch_rate"), InputError);
  for (const int channel : kInputs) CHECK(noise[static_cast<std::size_t>(channel)] > 0.0);
  CHECK(noise[C::kTime] == 0.0);
}

TEST_CASE("A coarse sweep is differentiated accurately", "[unit]") {
  SolverOptions coarse;
  coarse.options.step = {Stepper::kAbm4, 2e-3, false, 8e-3};
  coarse.options.closure = Closure::kTable;
  const IntegrateOptions options = make_accurate(coarse).options;
  CHECK(options.step.stepper == Stepper::kRk4);
  CHECK(options.step.step == 1e-3);
  CHECK(options.step.locate_events);
  CHECK(options.step.coarse_step == 0.0);
  CHECK(options.closure == Closure::kNewton);
  coarse.options.step.step = 0.2e-3;
  CHECK(make_accurate(coarse).options.step.step == 0.2e-3);
}

TEST_CASE("More instants of the paper's sweep never worsen a bound", "[property]") {
  const Design& design = paper_design();
  REQUIRE(design.best.size() == 3);
  CHECK(design.best[0].bounds.rms < design.snapshot.rms);
  CHECK(design.best[1].bounds.rms < design.best[0].bounds.rms);
  CHECK(design.best[2].bounds.rms < design.best[1].bounds.rms);
  for (const Bounds& single : design.scan) {
    CHECK(design.best[0].bounds.rms <= single.rms);
    for (std::size_t p = 0; p < single.bound.size(); ++p) {
      REQUIRE(design.window.bound[p] <= single.bound[p]);
    }
  }
}

TEST_CASE("Removing a sensor never lowers a bound, adding one never raises it", "[property]") {
  const auto& sets = paper_design().sensors;
  REQUIRE(sets.size() == 1 + kInputs.size() + 3);
  for (std::size_t i = 1; i <= kInputs.size(); ++i) {
    CHECK_THAT(sets[i].label, Contains("without"));
    for (std::size_t p = 0; p < 4; ++p)
      CHECK(sets[i].snapshot.bound[p] >= sets[0].snapshot.bound[p]);
  }
  for (std::size_t i = kInputs.size() + 1; i < sets.size(); ++i) {
    const SensorSet& before = i == kInputs.size() + 1 ? sets[0] : sets[i - 1];
    for (std::size_t p = 0; p < 4; ++p) CHECK(sets[i].window.bound[p] <= before.window.bound[p]);
    CHECK(sets[i].snapshot.rms < before.snapshot.rms);
  }
}

TEST_CASE("The bounds of the paper's instant and of the best instant are unchanged",
          "[regression]") {
  const Design& design = paper_design();
  const Instant& best = paper_sensitivity().instants[design.best[0].instants[0]];
  CHECK(design.snapshot.rms == Approx(5.6).epsilon(tolerance(0.02)));
  CHECK(design.best[0].bounds.rms == Approx(3.04).epsilon(tolerance(0.02)));
  CHECK(best.offset == Approx(-0.20).margin(tolerance(0.05)));
}

TEST_CASE("Left and right springs are known equally well, without roll only their sum",
          "[property]") {
  const Case c = make_base_point(make_request().base, make_request().grid, {}, {});
  const std::vector<Axis> axes{{"rear_left_stiffness", 0.0, 0.0, 1},
                               {"rear_right_stiffness", 0.0, 0.0, 1}};
  const Sensitivity s = calc_sensitivity(c, axes, 0.0, {});
  const Design without = calc_design(s, kInputs, make_default_noise());
  CHECK(without.window.rank == 1);
  CHECK(std::isinf(without.window.bound[0]));
  CHECK(without.window.weakest[0] == Approx(-without.window.weakest[1]));
  std::vector<int> channels = kInputs;
  channels.push_back(C::kRollRate);
  const Design with = calc_design(s, channels, make_default_noise());
  CHECK(with.window.rank == 2);
  CHECK(with.window.bound[0] == Approx(with.window.bound[1]).epsilon(tolerance(1e-4)));
}

TEST_CASE("A grid parameter without effect on the channels is not identifiable", "[property]") {
  const Case c = make_base_point(make_request().base, make_request().grid, {}, {});
  const std::vector<Axis> axes{{"imu_position_x", -0.5, 1.0, 2}, {"rear_damping", 0.0, 0.0, 1}};
  const Design design =
      calc_design(calc_sensitivity(c, axes, 0.0, {}), kInputs, make_default_noise());
  CHECK(std::isinf(design.window.bound[0]));
  CHECK(std::isfinite(design.window.bound[1]));
}

TEST_CASE("A channel without sensor asks for its noise", "[unit]") {
  CHECK_THROWS_WITH(calc_design(paper_sensitivity(), {C::kForwardPosition}, make_default_noise()),
                    Contains("--noise forward_position=SIGMA"));
}

/// `strut design` on the paper's sweep.
Outcome run_design(const TemporaryFolder& folder, const std::string& arguments) {
  const std::string sweep = folder.write(
      "sweep.toml", "vehicle = \"" + kExamples + "/vehicles/paper_sedan.toml\"\nmaneuver = \"" +
                        kExamples + "/maneuvers/bump_20mps.toml\"\n" + R"([grid]
front_stiffness = { from = 40000, to = 35500, step = -500 }
front_damping   = { from = 1980,  to = 1800,  step = -20 }
rear_stiffness  = { from = 35000, to = 30500, step = -500 }
rear_damping    = { from = 1980,  to = 1800,  step = -20 }
[record]
snapshot = { when = "rear_wheels_on_bump", offset = 0.0, channels = ["body_position_z", "body_velocity_z", "body_acceleration_z", "pitch_angle", "pitch_rate"] }
)");
  return run_program("design " + sweep + " " + arguments);
}

TEST_CASE("Design prints bounds, sensors and a proposal", "[io]") {
  const TemporaryFolder folder;
  const Outcome outcome = run_design(folder, "");
  CHECK(outcome.code == 0);
  CHECK_THAT(outcome.messages, Catch::Matchers::StartsWith("next: strut plan "));
  CHECK_THAT(outcome.out, Contains("the sweep's instant") && Contains("best 3 instants") &&
                              Contains("without pitch_rate") && Contains("least known") &&
                              Contains("put `offset = -0.2"));
}

TEST_CASE("Design writes strict JSON and the curves as CSV", "[io]") {
  const TemporaryFolder folder;
  const std::string csv = folder / "curves.csv";
  const Outcome outcome =
      run_design(folder, "--json --rate 500 --noise pitch_rate=0.002 --csv " + csv);
  REQUIRE(outcome.code == 0);
  const test::JsonTree json = test::parse_json(outcome.out);
  CHECK(json.get<double>("base.front_stiffness") == 37750.0);
  CHECK(json.get<double>("noise.pitch_rate") == 0.002);
  CHECK(json.get<double>("snapshot.offset") == 0.0);
  CHECK(json.get<double>("snapshot.parameters.front_stiffness.percent") ==
        Approx(json.get<double>("snapshot.parameters.front_stiffness.bound") / 377.5));
  CHECK(json.get_child("best").size() == 3);
  const CsvTable table = read_csv(csv);
  CHECK(table.row_count() == json.get_child("scan.offset").size());
  CHECK(table.row_count() == json.get<std::size_t>("window.samples"));
  CHECK(table.column("pitch_rate/rear_damping").unit == "rad/s per %");
}

TEST_CASE("Design refuses invalid arguments and lists the allowed ones", "[io]") {
  struct Wrong {
    const char *arguments, *message;
  };
  const TemporaryFolder folder;
  for (const Wrong& wrong :
       {Wrong{"--at front_stifness=38000", "did you mean 'front_stiffness'?"},
        Wrong{"--at front_stiffness=1", "front_stiffness"},
        Wrong{"--noise pitch_rate=-1", "must be > 0 rad/s"},
        Wrong{"--channels pitch_rte", "did you mean 'pitch_rate'?"},
        Wrong{"--channels pitch_rate,pitch_rate", "twice"},
        Wrong{"--channels tire_force", "unknown channel"},
        Wrong{"--rate 1", "--rate = 1: must lie in"}, Wrong{"--set speed=0.6", "never meets"},
        Wrong{"--difference 1", "--difference = 1: must lie in"},
        Wrong{"other.toml", "expected SWEEP.toml"}}) {
    INFO(wrong.arguments);
    const Outcome outcome = run_design(folder, wrong.arguments);
    CHECK(outcome.code == 2);
    CHECK(outcome.out.empty());
    CHECK_THAT(outcome.messages, Contains(wrong.message));
  }
  const Outcome full = run_design(folder, "--csv /nonexistent/curves.csv");
  CHECK(full.code == 3);
  CHECK(full.out.empty());
}

}  // namespace
}  // namespace strut
