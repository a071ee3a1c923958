// Small sweeps of the paper's car for tests of the factory.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "sweep/run.h"
#include "sweep/verify.h"
#include "tests/support/temporary_folder.h"

namespace strut::test {

/// Parts of a sweep file; every text is TOML.
struct SweepText {
  std::string grid =
      "front_stiffness = { from = 40000, to = 36000, step = -2000 }\n"
      "front_damping = { from = 1980, to = 1900, step = -40 }\n"
      "rear_stiffness = { from = 35000, to = 33000, step = -1000 }\n";
  std::string sample = "strata = 3\n";
  std::string integrate = "method = \"rk4\"\nstep = 2e-3\nclosure = \"table\"\n";
  std::string history;  // "history = { ... }"
  int shard_cases = 5;
};

inline std::filesystem::path write_sweep(const TemporaryFolder& folder, const SweepText& text) {
  const std::string examples = STRUT_SOURCE_DIR "/examples";
  return folder.write("sweep.toml",
                      "vehicle = \"" + examples + "/vehicles/paper_sedan.toml\"\nmaneuver = \"" +
                          examples + "/maneuvers/bump_20mps.toml\"\n[grid]\n" + text.grid +
                          "[sample]\n" + text.sample + "[integrate]\n" + text.integrate +
                          "[record]\nsnapshot = { when = \"rear_wheels_on_bump\", channels = "
                          "[\"body_position_z\", \"body_acceleration_z\", \"pitch_rate\"] }\n" +
                          text.history + "\n[shards]\ncases = " + std::to_string(text.shard_cases) +
                          "\n");
}

/// A planned sweep in a folder of its own.
class PlannedSweep {
 public:
  explicit PlannedSweep(const SweepText& text = {})
      : plan_(read_request(write_sweep(files_, text))),
        folder_(make_sweep_folder(files_ / "sweep", plan_)) {}

  const Plan& plan() const { return plan_; }
  const SweepFolder& folder() const { return folder_; }

  RunSummary run(int threads = 1, bool retries = false) const {
    RunOptions options;
    options.kernel = &list_kernels().front();
    options.threads = threads;
    options.retry_failed = retries;
    RunProgress progress;
    std::atomic<bool> halt{false};
    return run_sweep(folder_, plan_, options, progress, halt);
  }

  VerifyReport verify(std::int64_t sample = 0) const {
    VerifyOptions options;
    options.sample = sample;
    options.fallback = &list_kernels().front();
    return verify_sweep(folder_, plan_, options, [](std::int64_t) {});
  }

 private:
  TemporaryFolder files_;
  Plan plan_;
  SweepFolder folder_;
};

}  // namespace strut::test
