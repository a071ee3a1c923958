// strut submit, status, cancel and doctor without a cluster, and the warning of a time limit.
#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/jobs/program_sweep.h"

namespace strut {
namespace {

namespace fs = std::filesystem;
using Catch::Contains;
using Clock = std::chrono::steady_clock;
using test::Outcome;
using test::ProgramSweep;
using test::run_sweep_command;

const ProgramSweep& get_sweep() {
  static const ProgramSweep sweep(test::make_coarse_sweep(8, "", "5e-5"));
  return sweep;
}

test::JsonTree read_status(const fs::path& sweep) {
  return test::parse_json(run_sweep_command("status", sweep, "--json").out);
}

/// Waits until the last submission has ended.
test::JsonTree wait_for_end(const fs::path& sweep) {
  const Clock::time_point end = Clock::now() + std::chrono::seconds(60);
  for (;;) {
    test::JsonTree status = read_status(sweep);
    const auto& last = status.get_child("submissions").back().second;
    if (last.get<std::string>("state") == "ended" || Clock::now() > end) return status;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
}

TEST_CASE("A sweep submitted here equals the sweep that was run", "[io]") {
  const fs::path sweep = get_sweep().copy("submitted");
  const Outcome outcome =
      run_sweep_command("submit", sweep, "--to local --threads 1 --minutes 0.001 --merge --json");
  INFO(outcome.messages);
  REQUIRE(outcome.code == 0);
  const auto submitted = test::parse_json(outcome.out);
  CHECK(submitted.get<std::string>("submission") == "001");
  CHECK(submitted.get<int>("tasks") == 6);
  const auto status = wait_for_end(sweep);
  CHECK(status.get<bool>("complete"));
  const auto& jobs = status.get_child("submissions").front().second;
  CHECK(jobs.get<int>("ended.done") == 6);
  CHECK(fs::exists(sweep / "merged.h5"));
  get_sweep().check_whole(sweep);

  const Outcome again = run_sweep_command("submit", sweep, "--to local");
  CHECK(again.code == 0);
  CHECK_THAT(again.out, Contains("nothing to submit"));
}

TEST_CASE("A submission is cancelled, and another completes the sweep", "[io]") {
  const fs::path sweep = get_sweep().copy("cancelled");
  REQUIRE(run_sweep_command("submit", sweep, "--to local --threads 1").code == 0);
  const Outcome second = run_sweep_command("submit", sweep, "--to local");
  CHECK_THAT(second.out, Contains("nothing to submit"));
  const Outcome outcome = run_sweep_command("cancel", sweep);
  CHECK(outcome.code == 0);
  CHECK_THAT(outcome.out, Contains("1 job cancelled"));
  const auto status = wait_for_end(sweep);
  CHECK(status.get_child("submissions").front().second.get<bool>("cancelled"));
  CHECK(test::verify_by_program(sweep).damaged.empty());
  REQUIRE(run_sweep_command("submit", sweep, "--to local").code == 0);
  CHECK(wait_for_end(sweep).get<bool>("complete"));
  get_sweep().check_whole(sweep);
  CHECK_FALSE(fs::exists(sweep / "merged.h5"));
}

TEST_CASE("Failed cases are retried after the arrays", "[io]") {
  const test::TemporaryFolder folder;
  const std::string file = folder.write("failing.toml", test::make_failing_sweep()).string();
  const fs::path sweep = folder / "failing";
  REQUIRE(test::run_program("plan " + file + " -o " + sweep.string()).code == 0);
  REQUIRE(run_sweep_command("run", sweep).code == 1);
  const Outcome plain = run_sweep_command("submit", sweep, "--to local");
  CHECK_THAT(plain.out, Contains("nothing to submit") && Contains("cases failed"));
  CHECK_THAT(plain.messages, !Contains("--retry"));  // no smaller step helps
  const Outcome outcome = run_sweep_command("submit", sweep, "--to local --retry --merge");
  CHECK(outcome.code == 0);
  CHECK_THAT(outcome.out, Contains("one task that retries, of ") && Contains("retry: local"));
  wait_for_end(sweep);
  // No smaller step helps these cases, but they were tried, after no array and before the merge.
  std::string told;
  for (const fs::directory_entry& log : fs::directory_iterator(sweep / "logs")) {
    if (log.path().string().find(".retry.log") != std::string::npos) {
      told = test::read_text(log.path());
    }
  }
  CHECK_THAT(told, Contains("0 cases simulated") && Contains("failed in all"));
  CHECK(fs::exists(sweep / "merged.h5"));
}

TEST_CASE("A dry run shows the scripts and queues nothing", "[io]") {
  const fs::path sweep = get_sweep().copy("dry");
  const Outcome outcome = run_sweep_command("submit", sweep, "--to local --merge --dry-run");
  CHECK(outcome.code == 0);
  CHECK_THAT(outcome.out, Contains("#!/bin/bash") && Contains("--task NEXT/0/") &&
                              Contains("merged.h5") && Contains("--force") &&
                              !Contains("--virtual") && Contains("nothing is queued"));
  const test::JsonTree json = test::parse_json(
      run_sweep_command("submit", sweep, "--to local --merge --dry-run --json").out);
  const auto& parts = json.get_child("parts");
  REQUIRE(parts.size() == 2);
  const auto &array = parts.front().second, &merge = parts.back().second;
  CHECK_THAT(outcome.out, Contains(array.get<std::string>("script")) &&
                              Contains(merge.get<std::string>("script")));
  CHECK(merge.get_child("after").front().second.data() == array.get<std::string>("part"));
  CHECK_FALSE(fs::exists(sweep / "jobs"));
}

TEST_CASE("Commands for any other scheduler do the work of a submission", "[io]") {
  const fs::path sweep = get_sweep().copy("listed");
  const Outcome outcome = run_sweep_command("submit", sweep, "--to list --minutes 1e-6 --merge");
  INFO(outcome.messages);
  REQUIRE(outcome.code == 0);
  CHECK_FALSE(fs::exists(sweep / "jobs"));
  std::istringstream lines(outcome.out);
  int runs = 0;
  for (std::string line; std::getline(lines, line);) {
    INFO(line);
    REQUIRE(line.starts_with("strut "));
    runs += line.starts_with("strut run ") ? 1 : 0;
    CHECK(test::run_shell(STRUT_PROGRAM + line.substr(std::string("strut").size())).code == 0);
  }
  CHECK(runs == 6);
  get_sweep().check_whole(sweep);
  CHECK(fs::exists(sweep / "merged.h5"));
}

TEST_CASE("A prologue runs before the program, and may put words before it", "[io]") {
  const fs::path sweep = get_sweep().copy("prologue");
  const fs::path prologue = sweep.parent_path() / "prologue.sh",
                 mark = sweep.parent_path() / "mark";
  std::ofstream(prologue) << "echo \"$NOT_SET\" > " << mark.string()
                          << "\nlauncher=(env STRUT_LAUNCHED=1)\n";
  const std::string options = "--to local --prologue " + prologue.string();
  const Outcome dry = run_sweep_command("submit", sweep, options + " --dry-run");
  CHECK_THAT(dry.out, Contains("launcher=(env STRUT_LAUNCHED=1)") &&
                          Contains("\"${launcher[@]}\" \"$program\" run"));
  REQUIRE(run_sweep_command("submit", sweep, options).code == 0);
  test::run_shell("for i in $(seq 200); do " STRUT_PROGRAM " status " + sweep.string() +
                  " | grep -q '^left *0' && break; sleep 0.05; done");
  get_sweep().check_whole(sweep);
  CHECK(fs::exists(mark));
  CHECK(run_sweep_command("submit", sweep, "--to local --prologue /nowhere").code == 2);
}

TEST_CASE("A dry run needs no scheduler", "[io]") {
  const fs::path sweep = get_sweep().copy("away");
  const Outcome outcome =
      run_sweep_command("submit", sweep, "--to slurm --dry-run --partition x", "PATH=/nowhere");
  INFO(outcome.messages);
  CHECK(outcome.code == 0);
  CHECK_THAT(outcome.messages, Contains("no Slurm answers here (sbatch: "));
  CHECK_THAT(outcome.out, Contains("sbatch --parsable") && Contains("nothing is queued"));
  CHECK(run_sweep_command("submit", sweep, "--to slurm", "PATH=/nowhere").code == 3);
  for (const char* wrong : {"--memory -4", "--memory 4X", "--option '--qos low'", "--option qos"}) {
    const Outcome refused = run_sweep_command(
        "submit", sweep, std::string("--to slurm --dry-run ") + wrong, "PATH=/nowhere");
    INFO(wrong);
    CHECK(refused.code == 2);
    CHECK_THAT(refused.messages, Contains(std::string(wrong).substr(0, 8)));
  }
}

TEST_CASE("A sweep warned of its time limit finishes the current shard", "[io]") {
  const fs::path sweep = get_sweep().copy("warned");
  const Outcome outcome = test::run_shell(
      "(" STRUT_PROGRAM " run " + sweep.string() +
      " --threads 1 --json & pid=$!; while [ -z \"$(ls " + (sweep / "shards").string() +
      ")\" ]; do sleep 0.01; done; kill -USR1 $pid; wait $pid)");
  CHECK(outcome.code == 138);
  CHECK_THAT(outcome.messages, Contains("time limit") && Contains("continues from here"));
  const auto json = test::parse_json(outcome.out);
  CHECK(json.get<int>("written") < 48);
  // The shard in progress was finished: no simulated case is lost.
  CHECK(json.get<int>("written") % 8 == 0);
  CHECK(fs::is_empty(sweep / "claims"));
  CHECK(run_sweep_command("run", sweep).code == 0);
  get_sweep().check_whole(sweep);
}

TEST_CASE("An invalid submission is refused before anything is queued", "[io]") {
  const fs::path sweep = get_sweep().copy("refused");
  const auto submit = [&](const std::string& options, const std::string& variables = "") {
    return run_sweep_command("submit", sweep, options, variables);
  };
  CHECK_THAT(submit("").messages, Contains("--to: missing") && Contains("slurm"));
  CHECK(submit("").code == 2);
  CHECK(submit("--to pbs").code == 2);
  CHECK(submit("--to local --partition short").code == 2);
  CHECK(submit("--to local --time soon").code == 2);
  const Outcome bare = submit("--to slurm", "PATH=/nowhere");
  CHECK(bare.code == 3);
  CHECK_THAT(bare.messages, Contains("sbatch") && Contains("--to local"));
  CHECK(run_sweep_command("run", sweep, "--task 001/0/0").code == 2);
  CHECK_FALSE(fs::exists(sweep / "jobs"));
  CHECK_THAT(run_sweep_command("cancel", sweep).out, Contains("nothing to cancel"));
}

TEST_CASE("The doctor reports which promises hold", "[io]") {
  const fs::path sweep = get_sweep().copy("doctor");
  const Outcome outcome = run_sweep_command("doctor", sweep, "--to local --json");
  CHECK(outcome.code == 0);
  std::vector<std::string> checks;
  const auto found = test::parse_json(outcome.out);
  for (const auto& [key, check] : found.get_child("checks")) {
    checks.push_back(check.get<std::string>("check"));
    CHECK(check.get<std::string>("health") != "bad");
  }
  for (const char* wanted : {"exclusive create", "publishing", "rename", "flush to disk", "space",
                             "files", "clock of the file system", "scheduler"}) {
    CHECK(std::find(checks.begin(), checks.end(), wanted) != checks.end());
  }
  // It leaves no files.
  for (const fs::directory_entry& entry : fs::directory_iterator(sweep)) {
    CHECK(entry.path().filename().string().rfind("doctor.", 0) != 0);
  }
  CHECK(run_sweep_command("doctor", "/proc").code == 3);
  CHECK(run_sweep_command("doctor", sweep / "request.toml").code == 2);
}

}  // namespace
}  // namespace strut
