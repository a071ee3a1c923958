// Rigs and what drives them from their files, and the files that ship.
#include "model_files/read_rig.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "base/error/input_error.h"
#include "model/rig/rig_system.h"
#include "tests/support/temporary_folder.h"

namespace strut {
namespace {

const std::filesystem::path kRigs = std::filesystem::path(STRUT_SOURCE_DIR) / "examples" / "rigs";

template <class Function>
std::string get_message(const Function& function) {
  try {
    function();
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

void check_contains(const std::string& text, const std::string& part) {
  INFO(text);
  CHECK(text.find(part) != std::string::npos);
}

LaneResults run_example(const std::string& rig, const std::string& maneuver) {
  const RigSpec spec = read_rig(kRigs / rig);
  const RigManeuver driven = read_rig_maneuver(kRigs / "maneuvers" / maneuver, spec.kind);
  SamplePlan plan;
  plan.duration = driven.duration;
  plan.interval = 0.01;
  return simulate_rig(spec, driven.inputs, StepOptions{}, plan);
}

TEST_CASE("The rigs that ship run under the maneuvers that ship", "[io][rigs]") {
  const std::pair<std::string, std::string> pairs[] = {{"quarter_car.toml", "bump.toml"},
                                                       {"quarter_car.toml", "chirp.toml"},
                                                       {"strut_rig.toml", "dynamometer.toml"},
                                                       {"single_mass.toml", "force_step.toml"},
                                                       {"guided_mass.toml", "shaker.toml"}};
  for (const auto& [rig, maneuver] : pairs) {
    INFO(rig << " " << maneuver);
    const LaneResults run = run_example(rig, maneuver);
    CHECK(run.status[0] == 0);
    for (const double value : run.history) REQUIRE(std::isfinite(value));
    CHECK(find_rig_kind(kRigs / rig) == read_rig(kRigs / rig).kind);
  }
}

TEST_CASE("A pushed oscillator ends where its spring holds it", "[io][rigs]") {
  const LaneResults run = run_example("single_mass.toml", "force_step.toml");
  // 9 periods at 5 % damping leave exp(-0.05 * 2 pi * 9) = 6 % of 1 N / k.
  CHECK(run.final_state[0] == Approx(1.0 / 39.4784176).epsilon(0.06));
}

TEST_CASE("Other types of vehicle files are no rigs", "[io][rigs]") {
  const test::TemporaryFolder folder;
  CHECK_FALSE(find_rig_kind(folder.write("car.toml", "type = \"full_vehicle\"\n")));
  CHECK_FALSE(find_rig_kind(folder.write("none.toml", "mass = 1.0\n")));
  CHECK(find_rig_kind(folder.write("mass.toml", "type = \"single_mass\"\n")) ==
        RigKind::kSingleMass);
}

TEST_CASE("A rig's file is read completely or refused", "[io][rigs]") {
  const test::TemporaryFolder folder;
  const std::string text =
      "type = \"quarter_car\"\nsprung_mass = 2.0\nunsprung_mass = 1.0\nstiffness = 900\n"
      "damping = 7\ntire_stiffness = 1250\ntire_damping = 5\n";
  const RigSpec spec = read_rig(folder.write(
      "rig.toml", text + "tire_contact = \"unilateral\"\ngravity = 1.6\n"
                         "[initial]\nunsprung_position = 0.1\nsprung_velocity = -2.0\n"));
  RigSpec expected;
  expected.name = "rig";
  expected.sprung_mass = 2.0;
  expected.unsprung_mass = 1.0;
  expected.stiffness = 900.0;
  expected.damping = 7.0;
  expected.tire_stiffness = 1250.0;
  expected.tire_damping = 5.0;
  expected.gravity = 1.6;
  expected.unilateral_tire = true;
  expected.initial_position = {0.1, 0.0};
  expected.initial_velocity = {0.0, -2.0};
  CHECK(spec == expected);

  const auto refuse = [&](const std::string& addition) {
    return get_message([&] { read_rig(folder.write("rig.toml", text + addition)); });
  };
  check_contains(refuse(""), "tire_contact");
  check_contains(refuse("tire_contact = \"glued\"\n"), "unilateral");
  check_contains(refuse("tire_contact = \"bilateral\"\ngravitty = 9.81\n"), "gravity");
  check_contains(refuse("tire_contact = \"bilateral\"\ngravity = -9.81\n"), "rig.toml:9: gravity");
  check_contains(refuse("tire_contact = \"bilateral\"\ntire_curve = [[0, 0], [0.01, 90]]\n"),
                 "tire_curve = ");
}

TEST_CASE("A rig's tire may be a measured curve", "[io][rigs]") {
  const test::TemporaryFolder folder;
  const std::string text =
      "type = \"quarter_car\"\nsprung_mass = 2.0\nunsprung_mass = 1.0\nstiffness = 900\n"
      "tire_damping = 5\ntire_contact = \"bilateral\"\n";
  const auto read = [&](const std::string& curve) {
    return read_rig(folder.write("rig.toml", text + "tire_curve = " + curve + "\n"));
  };
  const RigSpec spec = read("[[0, 0], [0.01, 10], [0.02, 30]]");
  CHECK(spec.tire_curve.x == std::vector<double>{0.0, 0.01, 0.02});
  CHECK(spec.tire_stiffness == Approx((0.1 + 0.6) / 5e-4));
  check_contains(get_message([&] { read("[[0], [0.01]]"); }), "[m, N]");
  check_contains(get_message([&] { read("[[0, 0], [0.01, 10], [0.02, 5]]"); }), "must increase");
}

TEST_CASE("A recording drives a rig by its own columns and times", "[io][rigs]") {
  const test::TemporaryFolder folder;
  folder.write("run.csv", "t_s,z_mm,F\n0,0,1\n0.25,2,1\n0.5,0,1\n");
  const auto path = folder.write("maneuver.toml",
                                 "[input.road_position]\nshape = \"file\"\nfile = \"run.csv\"\n"
                                 "time = \"t_s\"\ncolumn = \"z_mm\"\nscale = -0.001\n"
                                 "offset = 0.5\ninterpolation = \"linear\"\n");
  const RigManeuver maneuver = read_rig_maneuver(path, RigKind::kQuarterCar);
  CHECK(maneuver.duration == 0.5);
  REQUIRE(maneuver.inputs.size() == 1);
  CHECK(maneuver.inputs[0].channel == "road_position");
  CHECK(calc_signal(maneuver.inputs[0], 0.125).value == Approx(0.499).epsilon(1e-15));
  CHECK(calc_signal(maneuver.inputs[0], 0.125).rate == Approx(-0.008).epsilon(1e-12));
}

TEST_CASE("What cannot drive a rig is refused with its place", "[io][rigs]") {
  const test::TemporaryFolder folder;
  folder.write("back.csv", "time,road_position\n0,0\n0.5,1\n0.25,2\n");
  const auto refuse = [&](const std::string& text, RigKind kind = RigKind::kQuarterCar) {
    return get_message([&] { read_rig_maneuver(folder.write("maneuver.toml", text), kind); });
  };
  const std::string road = "duration = 1.0\n[input.road_position]\n";
  check_contains(refuse("duration = 1.0\n[input.rod_position]\nshape = \"bump\"\n"),
                 "road_position");
  check_contains(refuse(road + "shape = \"file\"\nfile = \"back.csv\"\n"), "sample 3: time");
  check_contains(refuse(road + "shape = \"sine\"\namplitude = 1.0\nfrequency = 0.0\n"),
                 "maneuver.toml:5: input.road_position.frequency");
  check_contains(refuse("[input.road_position]\nshape = \"sine\"\n"), "duration");
  check_contains(refuse("duration = 1.0\n", RigKind::kStrutRig), "displacement: missing");
}

TEST_CASE("Parameters of a rig are set by name within their range", "[unit][rigs]") {
  RigSpec spec = read_rig(kRigs / "single_mass.toml");
  set_rig_parameter(spec, "mass", 3.0);
  CHECK(spec.sprung_mass == 3.0);
  check_contains(get_message([&] { set_rig_parameter(spec, "mass", -1.0); }), "mass = -1");
  check_contains(get_message([&] { set_rig_parameter(spec, "stifness", 1.0); }), "stiffness");
}

}  // namespace
}  // namespace strut
