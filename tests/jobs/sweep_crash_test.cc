// A sweep that dies at any moment goes on to the same data.
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <csignal>
#include <random>
#include <string>
#include <thread>

#include "tests/faults/replay.h"
#include "tests/faults/run_worker.h"
#include "tests/jobs/program_sweep.h"

namespace strut {
namespace {

namespace fs = std::filesystem;
using test::FolderState;

using test::ProgramSweep;
using test::run_sweep_command;

const std::string kSweep = test::make_coarse_sweep(8);

void check_whole(const ProgramSweep& planned, const fs::path& sweep) {
  planned.check_whole(sweep);
  // No whole shard was ever put aside.
  CHECK((!fs::exists(sweep / "quarantine") || fs::is_empty(sweep / "quarantine")));
}

/// Runs the sweep and kills it after so long. True: it had ended before.
bool run_and_kill(const fs::path& sweep, std::chrono::microseconds after) {
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    const int null = ::open("/dev/null", O_RDWR);
    ::dup2(null, STDOUT_FILENO);
    ::dup2(null, STDERR_FILENO);
    ::execl(STRUT_PROGRAM, STRUT_PROGRAM, "run", sweep.c_str(), "--threads", "2", nullptr);
    ::_exit(127);
  }
  std::this_thread::sleep_for(after);
  ::kill(child, SIGKILL);
  int status = 0;
  ::waitpid(child, &status, 0);
  if (WIFEXITED(status)) REQUIRE(WEXITSTATUS(status) == 0);
  return WIFEXITED(status);
}

TEST_CASE("A sweep killed 200 times at random moments ends with the same data", "[io][slow]") {
  const ProgramSweep planned(kSweep);
  const auto start = std::chrono::steady_clock::now();
  REQUIRE(run_sweep_command("run", planned.copy("timed"), "--threads 2").code == 0);
  const auto whole_run = std::chrono::steady_clock::now() - start;
  const double longest = std::chrono::duration<double, std::micro>(whole_run).count();

  std::mt19937 random(1);
  int kills = 0, sweeps = 0;
  while (kills < 200) {
    const fs::path sweep = planned.copy("killed");
    for (bool is_done = false; !is_done && kills < 200;) {
      const double part = static_cast<double>(random()) / 4294967296.0;
      is_done = run_and_kill(sweep, std::chrono::microseconds(std::llround(part * longest)));
      if (!is_done) ++kills;
    }
    INFO("after " << kills << " kills");
    REQUIRE(run_sweep_command("run", sweep, "--threads 2").code == 0);
    check_whole(planned, sweep);
    ++sweeps;
  }
  CHECK(sweeps >= 20);
}

TEST_CASE("A sweep that crashes at any write ends with the same data", "[io][slow]") {
  const ProgramSweep planned(kSweep);
  const fs::path sweep = planned.copy("recorded"), log = planned / "log";
  const FolderState before(sweep);
  REQUIRE(run_sweep_command("run", sweep, "--threads 2",
                            test::preload_faults(sweep, "STRUT_RECORD=" + log.string()))
              .code == 0);
  const auto operations = test::read_recording(log);
  const fs::path crashed = planned.copy("crashed");
  const auto check = [&](const FolderState& state, std::size_t, const std::string& what) {
    INFO(what);
    for (const auto& entry : fs::recursive_directory_iterator(crashed)) {
      if (!entry.is_directory()) fs::remove(entry.path());
    }
    state.write(crashed);
    // The recorded runner is gone, so nothing of it may stand in the way.
    REQUIRE(run_sweep_command("run", crashed, "--threads 2").code == 0);
    check_whole(planned, crashed);
  };
  const test::CrashStates kinds{.torn = true, .dropped = true, .distinct = true};
  const int states = test::for_each_crash_state(before, operations, kinds, check);
  CHECK(states >= 100);
}

}  // namespace
}  // namespace strut
