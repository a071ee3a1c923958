// A small sweep that the program itself plans, runs and verifies.
#pragma once

#include <catch2/catch.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/jobs/parse_json.h"
#include "tests/jobs/run_program.h"
#include "tests/support/temporary_folder.h"

namespace strut::test {

/// 48 cases, coarse: the files matter here, not the car. `history`: "history = { ... }".
inline std::string make_coarse_sweep(int shard_cases, const std::string& history = "",
                                     const std::string& step = "4e-3") {
  const std::string examples = STRUT_SOURCE_DIR "/examples";
  return "vehicle  = \"" + examples + "/vehicles/paper_sedan.toml\"\nmaneuver = \"" + examples +
         "/maneuvers/bump_20mps.toml\"\n" + R"(
[grid]
front_stiffness = { from = 40000, to = 35500, step = -1500 }
rear_stiffness  = { from = 35000, to = 30500, step = -1500 }
rear_damping    = { from = 1980,  to = 1800,  step = -90 }
[sample]
strata = 1
[integrate]
closure = "table"
step = )" +
         step +
         "\n[record]\nsnapshot = { when = \"rear_wheels_on_bump\", channels = "
         "[\"body_position_z\", \"pitch_rate\"] }\n" +
         history + "\n[shards]\ncases = " + std::to_string(shard_cases) + "\n";
}

/// 24 cases, some of which fail: flanks longer than half of their bump, and springs that cannot
/// carry the car.
inline std::string make_failing_sweep() {
  std::string text = make_coarse_sweep(5);
  const auto replace = [&text](const std::string& from, const std::string& to) {
    REQUIRE(text.find(from) != std::string::npos);
    text.replace(text.find(from), from.size(), to);
  };
  replace("bump_20mps", "one_sided");
  replace("rear_damping    = { from = 1980,  to = 1800,  step = -90 }",
          "bump_ramp = { from = 0.15, to = 0.45, count = 3 }");
  replace("to = 30500, step = -1500", "to = 2000, count = 2");
  return text;
}

/// `variables`: what stands before the command in a shell.
inline Outcome run_sweep_command(const std::string& command, const std::filesystem::path& sweep,
                                 const std::string& options = "",
                                 const std::string& variables = "") {
  return run_shell(variables + " " STRUT_PROGRAM " " + command + " " + sweep.string() + " " +
                   options);
}

/// The output of `strut verify --json`.
struct Verdict {
  int code = -1;
  bool ok = false;
  int missing = -1, twice = -1, foreign = -1;
  std::vector<std::string> damaged;
  std::string digest;
};

inline Verdict verify_by_program(const std::filesystem::path& sweep,
                                 const std::string& options = "") {
  const Outcome outcome = run_sweep_command("verify", sweep, "--json " + options);
  const JsonTree tree = parse_json(outcome.out);
  Verdict verdict{outcome.code,
                  tree.get<bool>("ok"),
                  tree.get<int>("missing"),
                  tree.get<int>("double"),
                  tree.get<int>("foreign"),
                  {},
                  tree.get<std::string>("data_digest")};
  for (const auto& [key, what] : tree.get_child("damaged")) verdict.damaged.push_back(what.data());
  return verdict;
}

/// A planned sweep to copy from, and the digest of its data.
class ProgramSweep {
 public:
  /// `code`: that of running it, 1 where cases fail.
  explicit ProgramSweep(const std::string& text, int code = 0) {
    const std::string file = files_.write("small.toml", text).string();
    REQUIRE(run_program("plan " + file + " -o " + planned_.string()).code == 0);
    const std::filesystem::path whole = copy("whole");
    REQUIRE(run_sweep_command("run", whole, "--threads 2").code == code);
    const Verdict verdict = verify_by_program(whole);
    REQUIRE(verdict.ok);
    digest_ = verdict.digest;
  }

  const std::string& digest() const { return digest_; }
  std::filesystem::path operator/(const std::string& name) const { return files_ / name; }
  void copy_to(const std::filesystem::path& target) const {
    std::filesystem::copy(planned_, target, std::filesystem::copy_options::recursive);
  }
  /// A planned folder of that name, anew.
  std::filesystem::path copy(const std::string& name) const {
    std::filesystem::remove_all(files_ / name);
    copy_to(files_ / name);
    return files_ / name;
  }

  /// All there, as of an undisturbed sweep, and nothing else left in the folder.
  void check_whole(const std::filesystem::path& sweep) const {
    const Verdict verdict = verify_by_program(sweep);
    CHECK(verdict.ok);
    CHECK(verdict.code == 0);
    CHECK(verdict.digest == digest_);
    CHECK(std::filesystem::is_empty(sweep / "tmp"));
    CHECK(std::filesystem::is_empty(sweep / "claims"));
  }

 private:
  TemporaryFolder files_;
  std::filesystem::path planned_ = files_ / "planned";
  std::string digest_;
};

}  // namespace strut::test
