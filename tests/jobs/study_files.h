// A small study that the program itself runs.
#pragma once

#include <catch2/catch.hpp>
#include <filesystem>
#include <map>
#include <regex>
#include <string>

#include "tests/jobs/parse_json.h"
#include "tests/jobs/run_program.h"

namespace strut::test {

namespace fs = std::filesystem;

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

/// Files of a study in a folder of their own; `more`: behind the study's text.
class StudyFiles {
 public:
  explicit StudyFiles(const std::string& more = "") : text_(kStudy + more) {
    write_sweep("sweep.toml", kSweep);
    files_.write("published.toml", kPublished);
    files_.write("study.toml", text_);
  }

  /// A sweep of the example car over the example bump.
  fs::path write_sweep(const std::string& name, const std::string& text) const {
    const std::string examples = STRUT_SOURCE_DIR "/examples";
    return files_.write(name, "vehicle = \"" + examples +
                                  "/vehicles/paper_sedan.toml\"\nmaneuver = \"" + examples +
                                  "/maneuvers/bump_20mps.toml\"\n" + text);
  }

  fs::path operator/(const std::string& name) const { return files_ / name; }

  /// The study with texts replaced, as study2.toml.
  std::string change(const std::string& from, const std::string& to) const {
    std::string text = text_;
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    text.replace(at, from.size(), to);
    return files_.write("study2.toml", text).string();
  }

  Outcome run_file(const std::string& study, const std::string& folder,
                   const std::string& options = "") const {
    return run_program("study " + study + " -o " + (files_ / folder).string() + " " + options);
  }
  Outcome run(const std::string& options = "", const std::string& folder = "made") const {
    return run_file((files_ / "study.toml").string(), folder, options);
  }

  /// A copy of "made", anew.
  fs::path copy(const std::string& folder) const {
    fs::path root = files_ / folder;
    fs::remove_all(root);
    fs::copy(files_ / "made", root, fs::copy_options::recursive);
    return root;
  }

 private:
  std::string text_;
  TemporaryFolder files_;
};

/// Runs the study into "made"; for a study that is made once, of which tests take copies.
inline const StudyFiles& require_run(const StudyFiles& files) {
  const Outcome outcome = files.run("--threads 2");
  INFO(outcome.messages);
  REQUIRE(outcome.code == 0);
  return files;
}

inline std::map<std::string, std::string> read_folder(const fs::path& root) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    if (entry.is_regular_file()) {
      files[entry.path().lexically_relative(root).string()] = test::read_text(entry.path());
    }
  }
  return files;
}

inline JsonTree read_results(const fs::path& root) {
  return test::parse_json(test::read_text(root / "results.json"));
}

/// results.json without what a clock says.
inline std::string drop_seconds(const fs::path& root) {
  return std::regex_replace(test::read_text(root / "results.json"),
                            std::regex("\"(fit_)?seconds\": [-+.e0-9]+"), "");
}

}  // namespace strut::test
