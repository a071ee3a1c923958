// A small sweep of histories, and a window's network trained on it by the program.
#pragma once

#include <catch2/catch.hpp>
#include <filesystem>
#include <string>

#include "tests/jobs/parse_json.h"
#include "tests/jobs/run_program.h"
#include "tests/support/temporary_folder.h"

namespace strut::test {

inline const std::string kExamples = STRUT_SOURCE_DIR "/examples";
/// The car and the bump of the sweep, whose runs are shorter.
inline const std::string kCar = kExamples + "/vehicles/paper_sedan.toml";
inline const std::string kBump = kExamples + "/maneuvers/bump_20mps.toml";

inline std::string make_sweep_text(const std::filesystem::path& maneuver, int seed) {
  return "vehicle = \"" + kCar + "\"\nmaneuver = \"" + maneuver.string() + "\"\n" + R"(
[grid]
front_stiffness = { from = 40000, to = 35500 }
rear_damping    = { from = 1980,  to = 1800 }
speed           = { from = 19.5,  to = 20.5 }
[sample]
method = "sobol"
strata = 1
count = 200
seed = )" +
         std::to_string(seed) +
         R"(
[integrate]
closure = "table"
step = 1e-3
[record]
snapshot = { when = "rear_wheels_on_bump", channels = ["body_position_z", "body_velocity_z", "pitch_angle"] }
history = { rate = 500, channels = ["imu_acceleration_z", "imu_rate_y"] }
[shards]
cases = 60
)";
}

/// A sweep of 200 cars that has run.
inline std::filesystem::path make_sweep(const TemporaryFolder& folder, int seed) {
  std::string bump = read_text(kBump);
  bump.replace(bump.find("duration = 3.0"), 14, "duration = 1.5");
  const std::filesystem::path maneuver = folder.write("bump.toml", bump);
  const std::string file = folder.write("sweep.toml", make_sweep_text(maneuver, seed)).string();
  std::filesystem::path made = folder / "sweep";
  const Outcome planned = run_program("plan " + file + " -o " + made.string());
  INFO(planned.messages);
  REQUIRE(planned.code == 0);
  REQUIRE(run_program("run " + made.string()).code == 0);
  return made;
}

/// One made once: nothing here changes it.
inline const std::filesystem::path& get_sweep() {
  static const TemporaryFolder folder;
  static const std::filesystem::path sweep = make_sweep(folder, 1);
  return sweep;
}

inline Outcome train(const std::string& data, const std::filesystem::path& output,
                     const std::string& options) {
  return run_program("train " + data + " -o " + output.string() +
                     " --targets front_stiffness,rear_damping --hidden 8 " + options);
}

/// Epochs that are enough to identify.
inline const std::string kLong = "--window 0.35:1.2 --copies 4 --epochs 60 ";

/// A model of that sweep, made once, and what the training printed.
struct Trained {
  Trained() {
    const Outcome outcome = train(get_sweep().string(), file, kLong + "--json");
    INFO(outcome.messages);
    REQUIRE(outcome.code == 0);
    printed = parse_json(outcome.out);
  }
  TemporaryFolder folder;
  std::filesystem::path file = folder / "window.h5";
  JsonTree printed;
};

inline const Trained& get_trained() {
  static const Trained trained;
  return trained;
}

}  // namespace strut::test
