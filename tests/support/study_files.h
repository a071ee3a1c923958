// A small study, without and with sensor noise, in a folder of its own.
#pragma once

#include <catch2/catch.hpp>
#include <filesystem>
#include <string>

#include "tests/support/temporary_folder.h"

namespace strut::test {

inline constexpr char kSweep[] = R"(
[grid]
front_stiffness = { from = 40000, to = 35500, step = -500 }
rear_stiffness  = { from = 35000, to = 30500, step = -500 }
[sample]
strata = 5
[integrate]
closure = "table"
step = 4e-3
[record]
snapshot = { when = "rear_wheels_on_bump", channels = ["body_position_z", "body_velocity_z", "body_acceleration_z", "pitch_angle"] }
[shards]
cases = 32
)";

inline constexpr char kStudy[] = R"(
title     = "Small <study>"
sweep     = "sweep.toml"
published = "published.toml"
preload = ["free_length", "trimmed"]
samples = [90, 70]
seeds   = 2
[networks]
small = [4]
wide  = [6, 3]
[inputs]
four = ["body_position_z", "body_velocity_z", "body_acceleration_z", "pitch_angle"]
two  = ["body_position_z", "pitch_angle"]
[best_instant]
trimmed = -0.5
[training]
epochs = 12
)";

inline constexpr char kPublished[] = R"(
source = "Somebody"
remarks = ["A remark."]
[cells.small_90_four]
table = "Table 1"
front_stiffness = { MAE = 100.0, MAPE = 0.3, RMSE = 150.0, R2 = 0.99 }
[cells.small_90_two]
table = "Table 2"
rear_stiffness = { MAE = 0.001 }
)";

/// The sweep of the windows.
inline constexpr char kWindows[] = R"(
[grid]
front_stiffness = { from = 40000, to = 35500 }
rear_stiffness  = { from = 35000, to = 30500 }
speed           = { from = 19.5,  to = 20.5 }
[sample]
method = "sobol"
strata = 1
count  = 90
[integrate]
closure = "table"
[record]
snapshot = { when = "rear_wheels_on_bump", channels = ["body_position_z"] }
history = { rate = 250, channels = ["imu_rate_y", "imu_acceleration_z"] }
)";

inline constexpr char kNoise[] = R"(
[noise]
window_sweep = "windows.toml"
window = [0.3, 1.3]
scales = [0.1, 1]
copies = 3
fits   = 12
)";
/// Files of a study in a folder of their own; `more` is appended to the study's text.
class StudyFiles {
 public:
  explicit StudyFiles(const std::string& more = "") : text_(kStudy + more) {
    write_sweep("sweep.toml", kSweep);
    files_.write("published.toml", kPublished);
    files_.write("study.toml", text_);
  }

  /// A sweep of the example car over the example bump.
  std::filesystem::path write_sweep(const std::string& name, const std::string& text) const {
    const std::string examples = STRUT_SOURCE_DIR "/examples";
    return files_.write(name, "vehicle = \"" + examples +
                                  "/vehicles/paper_sedan.toml\"\nmaneuver = \"" + examples +
                                  "/maneuvers/bump_20mps.toml\"\n" + text);
  }

  std::filesystem::path operator/(const std::string& name) const { return files_ / name; }

  /// The study with texts replaced, as study2.toml.
  std::string change(const std::string& from, const std::string& to) const {
    std::string text = text_;
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    text.replace(at, from.size(), to);
    return files_.write("study2.toml", text).string();
  }

 private:
  std::string text_;
  TemporaryFolder files_;
};

/// Adds the noise section and its sweep.
class NoiseStudyFiles : public StudyFiles {
 public:
  NoiseStudyFiles() : StudyFiles(kNoise) { write_sweep("windows.toml", kWindows); }
};

}  // namespace strut::test
