// Sweeps under faults of disks, limits, damage and clocks, through the program itself.
#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <fstream>
#include <set>
#include <string>

#include "io/format/hdf5.h"
#include "tests/faults/run_worker.h"
#include "tests/jobs/program_sweep.h"
#include "tests/support/small_disk.h"

namespace strut {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;
using test::Outcome;
using test::ProgramSweep;
using test::run_sweep_command;
using test::SmallDisk;
using test::Verdict;
using test::verify_by_program;

// Small enough to be done in a moment, large enough for several shards: 12 cases each.
const std::string kFourShards = test::make_coarse_sweep(12);

bool was_skipped(const SmallDisk& disk) {
  if (!disk.is_mounted()) WARN("skipped: a small file system can be mounted by root only");
  return !disk.is_mounted();
}

/// A run that the environment ended: it said why and where, and what it wrote is sound.
void check_failed_cleanly(const Outcome& outcome, const fs::path& sweep, const std::string& why) {
  CHECK(outcome.code == 3);
  CHECK_THAT(outcome.messages, Contains(sweep.string() + "/") && Contains(why));
  CHECK(fs::is_empty(sweep / "tmp"));
  CHECK(fs::is_empty(sweep / "claims"));
  const Verdict verdict = verify_by_program(sweep);
  CHECK(verdict.code == (verdict.missing > 0 ? 1 : 0));
  CHECK(verdict.damaged.empty());
  CHECK(verdict.twice == 0);
  CHECK(verdict.foreign == 0);
}

void check_completed(const ProgramSweep& planned, const fs::path& sweep) {
  const Outcome outcome = run_sweep_command("run", sweep, "--threads 2");
  INFO(outcome.messages);
  CHECK(outcome.code == 0);
  planned.check_whole(sweep);
}

TEST_CASE("A sweep meets a full disk, keeps what it has, and goes on once there is room",
          "[io][threads]") {
  // 18 MB of numbers, 1.5 MB a shard.
  const ProgramSweep planned(test::make_coarse_sweep(
      4,
      "history = { rate = 2000, channels = [\"body_acceleration_z\", \"pitch_rate\", "
      "\"imu_acceleration_x\", \"imu_acceleration_z\", \"front_left_wheel_acceleration_z\", "
      "\"rear_left_wheel_acceleration_z\", \"front_left_tire_force_z\", "
      "\"rear_left_tire_force_z\"] }"));
  const SmallDisk disk(planned / "disk", 8);
  if (was_skipped(disk)) return;
  const fs::path sweep = planned / "disk/sweep";
  planned.copy_to(sweep);
  const Outcome first = run_sweep_command("run", sweep, "--threads 2");
  check_failed_cleanly(first, sweep, "No space left on device");
  const int missing = verify_by_program(sweep).missing;
  CHECK(missing > 0);
  CHECK(missing < 48);
  // Once more, as a user would: no better, and no worse.
  check_failed_cleanly(run_sweep_command("run", sweep), sweep, "No space left on device");
  CHECK(verify_by_program(sweep).missing <= missing);
  REQUIRE(disk.set(64, false));
  check_completed(planned, sweep);
}

TEST_CASE("status waits for a slow file system's shards together, not one after the other",
          "[io][threads]") {
  // 304 shards of one case: fewer than 256 are read one after the other.
  std::string text = test::make_coarse_sweep(1);
  text.replace(text.find("step = -90"), 10, "step = -10");
  const ProgramSweep planned(text);
  const fs::path sweep = planned / "whole";
  const auto measure = [&](const std::string& variables) {
    const auto begin = std::chrono::steady_clock::now();
    const Outcome outcome = run_sweep_command("status", sweep, "--json", variables);
    CHECK(outcome.code == 0);
    CHECK_THAT(outcome.out, Contains("\"done\": 304"));
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  constexpr double kDelay = 0.02;  // s
  const double slow = measure(test::preload_faults(sweep, "STRUT_DELAY=20"));
  CHECK(slow > measure("") + 304 / 16 * kDelay);
  CHECK(slow < 304 * kDelay);
}

TEST_CASE("A limit of file size ends a sweep with a message, not by a signal", "[io][threads]") {
  const ProgramSweep planned(kFourShards);
  // 8 KiB in a shell's blocks: less than a shard, more than its journal.
  for (const std::string shell : {"ulimit -f 16;", "trap '' XFSZ; ulimit -f 16;"}) {
    INFO(shell);
    const fs::path sweep = planned.copy("limited");
    check_failed_cleanly(run_sweep_command("run", sweep, "--threads 2", shell), sweep,
                         "File too large");
    CHECK(verify_by_program(sweep).missing == 48);
    check_completed(planned, sweep);
  }
}

TEST_CASE("A sweep survives any one flush that fails", "[io][threads]") {
  const ProgramSweep planned(test::make_coarse_sweep(24));
  std::set<std::string> stages;
  int n = 0;
  for (bool fired = true; fired;) {
    INFO("flush " << ++n);
    const fs::path sweep = planned.copy("flushed"), mark = planned / "fired";
    fs::remove(mark);
    const Outcome outcome = run_sweep_command(
        "run", sweep, "--threads 2",
        test::preload_faults(sweep, "STRUT_FAULT=fsync:" + std::to_string(n) +
                                        ":5:once STRUT_FAULT_FIRED=" + mark.string()));
    fired = fs::exists(mark);
    if (fired) check_failed_cleanly(outcome, sweep, "cannot be flushed to the disk");
    if (!fired) CHECK(outcome.code == 0);
    check_completed(planned, sweep);
  }
  // The runner's file; of both shards content, folder and journal; the journal's folder.
  CHECK(n - 1 >= 8);
}

TEST_CASE("A sweep survives flushes that fail for good", "[io][threads]") {
  const ProgramSweep planned(kFourShards);
  const fs::path sweep = planned.copy("flushed");
  check_failed_cleanly(run_sweep_command("run", sweep, "--threads 2",
                                         test::preload_faults(sweep,
                                                              "STRUT_FAULT=fsync:3:5:forever "
                                                              "STRUT_FAULT_FIRED=" +
                                                                  (planned / "fired").string())),
                       sweep, "cannot be flushed to the disk");
  check_completed(planned, sweep);
}

TEST_CASE("A folder that became read-only can be read, and told so when written", "[io]") {
  const ProgramSweep planned(kFourShards);
  const SmallDisk disk(planned / "disk", 8);
  if (was_skipped(disk)) return;
  const fs::path sweep = planned / "disk/sweep";
  planned.copy_to(sweep);
  REQUIRE(run_sweep_command("run", sweep, "--shards 0:1").code == 0);
  REQUIRE(disk.set(8, true));
  const Outcome outcome = run_sweep_command("run", sweep);
  check_failed_cleanly(outcome, sweep, "Read-only file system");
  CHECK(verify_by_program(sweep).missing == 36);
  const auto status = test::parse_json(run_sweep_command("status", sweep, "--json").out);
  CHECK(status.get<int>("done") == 12);
  CHECK(status.get<int>("left") == 36);
  REQUIRE(disk.set(8, false));
  check_completed(planned, sweep);
}

void flip_bit(const fs::path& file, std::uintmax_t at) {
  std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
  stream.seekg(static_cast<std::streamoff>(at));
  const int byte = stream.get();
  stream.seekp(static_cast<std::streamoff>(at));
  stream.put(static_cast<char>(byte ^ 1));
}

bool is_named(const Verdict& verdict, const std::string& file) {
  return std::any_of(verdict.damaged.begin(), verdict.damaged.end(),
                     [&](const std::string& what) { return what.starts_with(file + ": "); });
}

TEST_CASE("Damaged and foreign shards are named, put aside, and made again", "[io]") {
  const ProgramSweep planned(kFourShards);
  // The same but for the step: another plan.
  const ProgramSweep other(test::make_coarse_sweep(12, "", "2e-3"));
  REQUIRE(other.digest() != planned.digest());
  const fs::path sweep = planned.copy("damaged"), shards = sweep / "shards";
  REQUIRE(run_sweep_command("run", sweep).code == 0);
  fs::resize_file(shards / "000000.h5", fs::file_size(shards / "000000.h5") - 1);
  fs::copy_file(other / "whole/shards/000001.h5", shards / "000001.h5",
                fs::copy_options::overwrite_existing);
  flip_bit(shards / "000002.h5", fs::file_size(shards / "000002.h5") / 2);
  Verdict verdict = verify_by_program(sweep);
  CHECK(verdict.code == 1);
  CHECK_FALSE(verdict.ok);
  CHECK(verdict.damaged.size() == 3);
  for (const std::string name : {"000000", "000001", "000002"}) {
    CHECK(is_named(verdict, "shards/" + name + ".h5"));
  }
  CHECK(verdict.missing == 36);
  CHECK(verdict.foreign == 12);
  verdict = verify_by_program(sweep, "--quarantine");
  CHECK(verdict.code == 1);
  CHECK(std::distance(fs::directory_iterator(sweep / "quarantine"), {}) == 3);
  CHECK(std::distance(fs::directory_iterator(shards), {}) == 1);
  check_completed(planned, sweep);
}

/// "2026-11-21T09:30:00Z" -> 2026
int read_year(const fs::path& shard) {
  return std::stoi(Hdf5Reader(shard).read_attribute("/", "finished"));
}

TEST_CASE("A clock set back by a year between two runs changes nothing", "[io]") {
  const ProgramSweep planned(kFourShards);
  const fs::path sweep = planned.copy("set_back");
  const std::string year_ago =
      test::preload_faults(sweep, "STRUT_CLOCK_SHIFT=" + std::to_string(-366 * 86400));
  REQUIRE(run_sweep_command("run", sweep, "--shards 0:2").code == 0);
  for (const std::string& variables : {std::string(), year_ago}) {
    const auto status =
        test::parse_json(run_sweep_command("status", sweep, "--json", variables).out);
    CHECK(status.get<int>("done") == 24);
    CHECK(status.get<int>("left") == 24);
    CHECK(status.get<int>("running") == 0);
    CHECK_FALSE(status.get<bool>("complete"));
  }
  const auto untouched = fs::last_write_time(sweep / "shards/000000.h5");
  const Outcome outcome = run_sweep_command("run", sweep, "--json", year_ago);
  CHECK(outcome.code == 0);
  const auto summary = test::parse_json(outcome.out);
  CHECK(summary.get<int>("present") == 24);
  CHECK(summary.get<int>("written") == 24);
  CHECK(fs::last_write_time(sweep / "shards/000000.h5") == untouched);
  // Seen to work: the clock was another.
  CHECK(read_year(sweep / "shards/000003.h5") < read_year(sweep / "shards/000000.h5"));
  planned.check_whole(sweep);
}

}  // namespace
}  // namespace strut
