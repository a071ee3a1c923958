// A sweep that dies at any moment goes on to the same data.
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

// Asked for by Boost's own parser, which uses the names it deprecates.
#define BOOST_BIND_GLOBAL_PLACEHOLDERS
#include <boost/property_tree/json_parser.hpp>
#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <random>
#include <sstream>
#include <string>
#include <thread>

#include "tests/faults/replay.h"
#include "tests/faults/run_worker.h"
#include "tests/temporary_folder.h"

namespace strut {
namespace {

namespace fs = std::filesystem;
using test::FolderState;
using test::read_text;
using test::TemporaryFolder;

const std::string kExamples = STRUT_SOURCE_DIR "/examples";

// 48 cases in 6 shards, coarse: the crash matters here, not the car.
const std::string kSweep = "vehicle  = \"" + kExamples + "/vehicles/paper_sedan.toml\"\n" +
                           "maneuver = \"" + kExamples + "/maneuvers/bump_20mps.toml\"\n" + R"(
[grid]
front_stiffness = { from = 40000, to = 35500, step = -1500 }
rear_stiffness  = { from = 35000, to = 30500, step = -1500 }
rear_damping    = { from = 1980,  to = 1800,  step = -90 }
[sample]
strata = 1
[integrate]
step    = 4e-3
closure = "table"
[record]
snapshot = { when = "rear_wheels_on_bump", channels = ["body_position_z", "pitch_rate"] }
[shards]
cases = 8
)";

int run_program(const std::string& variables, const std::string& arguments) {
  const std::string command =
      variables + " exec " STRUT_PROGRAM " " + arguments + " >/dev/null 2>&1";
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

struct Verdict {
  bool ok = false;
  std::string digest;
};

Verdict verify(const fs::path& sweep, const fs::path& output) {
  const std::string command = "exec " STRUT_PROGRAM " verify " + sweep.string() +
                              " --sample 0 --json >" + output.string() + " 2>/dev/null";
  REQUIRE(std::system(command.c_str()) >= 0);
  std::istringstream text(read_text(output));
  boost::property_tree::ptree tree;
  boost::property_tree::read_json(text, tree);
  return {tree.get<bool>("ok"), tree.get<std::string>("data_digest")};
}

struct Planned {
  TemporaryFolder folder;
  fs::path planned = folder / "planned", whole = folder / "whole", output = folder / "output";
  std::string digest;

  Planned() {
    REQUIRE(run_program("", "plan " + folder.write("small.toml", kSweep).string() + " -o " +
                                planned.string()) == 0);
    fs::copy(planned, whole, fs::copy_options::recursive);
    REQUIRE(run_program("", "run " + whole.string() + " --threads 2") == 0);
    const Verdict verdict = verify(whole, output);
    REQUIRE(verdict.ok);
    digest = verdict.digest;
  }

  /// A planned folder of that name, anew.
  fs::path copy(const std::string& name) const {
    fs::remove_all(folder / name);
    fs::copy(planned, folder / name, fs::copy_options::recursive);
    return folder / name;
  }

  void check_whole(const fs::path& sweep) const {
    const Verdict verdict = verify(sweep, output);
    CHECK(verdict.ok);
    CHECK(verdict.digest == digest);
    // What the killed ones left is cleared, and no whole shard was ever put aside.
    CHECK(fs::is_empty(sweep / "tmp"));
    CHECK((!fs::exists(sweep / "quarantine") || fs::is_empty(sweep / "quarantine")));
  }
};

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
  const Planned planned;
  const auto start = std::chrono::steady_clock::now();
  REQUIRE(run_program("", "run " + planned.copy("timed").string() + " --threads 2") == 0);
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
    REQUIRE(run_program("", "run " + sweep.string() + " --threads 2") == 0);
    planned.check_whole(sweep);
    ++sweeps;
  }
  CHECK(sweeps >= 20);
}

TEST_CASE("A sweep that crashes at any write ends with the same data", "[io][slow]") {
  const Planned planned;
  const fs::path sweep = planned.copy("recorded"), log = planned.folder / "log";
  const FolderState before(sweep);
  REQUIRE(run_program(test::preload_faults(sweep, "STRUT_RECORD=" + log.string()),
                      "run " + sweep.string() + " --threads 2") == 0);
  const auto operations = test::read_recording(log);
  const fs::path crashed = planned.copy("crashed");
  const auto check = [&](const FolderState& state, std::size_t, const std::string& what) {
    INFO(what);
    for (const auto& entry : fs::recursive_directory_iterator(crashed)) {
      if (!entry.is_directory()) fs::remove(entry.path());
    }
    state.write(crashed);
    // The recorded runner is gone, so nothing of it may stand in the way.
    REQUIRE(run_program("", "run " + crashed.string() + " --threads 2") == 0);
    planned.check_whole(crashed);
  };
  const test::CrashStates kinds{.torn = true, .dropped = true, .distinct = true};
  const int states = test::for_each_crash_state(before, operations, kinds, check);
  CHECK(states >= 100);
}

}  // namespace
}  // namespace strut
