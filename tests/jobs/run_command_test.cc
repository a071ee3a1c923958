// `strut run`, `resume`, `status` and `verify` as a user meets them: signals, a second runner,
// wrong arguments, what scripts read.
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "tests/jobs/program_sweep.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

using Catch::Matchers::Contains;
using test::JsonTree;
using test::Outcome;
using test::parse_json;
using test::ProgramSweep;
using test::read_text;
using test::run_program;
using test::run_sweep_command;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

int count_files(const fs::path& folder) {
  return static_cast<int>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

/// Six shards of a full batch each, which takes a good tenth of a second.
const ProgramSweep& get_slow_sweep() {
  static const ProgramSweep sweep(test::make_coarse_sweep(8, "", "1e-4"));
  return sweep;
}

const ProgramSweep& get_quick_sweep() {
  static const ProgramSweep sweep(test::make_coarse_sweep(5));
  return sweep;
}

/// The program as a child to send signals to; its output goes to `DIR.out`.
class Child {
 public:
  Child(const std::string& command, const fs::path& sweep, const std::string& threads)
      : out_(sweep.string() + "." + std::to_string(++count_) + ".out"), pid_(::fork()) {
    REQUIRE(pid_ >= 0);
    if (pid_ > 0) return;
    const bool redirected = std::freopen(out_.c_str(), "w", stdout) != nullptr &&
                            std::freopen((out_ + ".err").c_str(), "w", stderr) != nullptr;
    if (redirected) {
      ::execl(STRUT_PROGRAM, STRUT_PROGRAM, command.c_str(), sweep.c_str(), "--threads",
              threads.c_str(), "--json", nullptr);
    }
    ::_exit(127);
  }
  ~Child() {
    if (pid_ <= 0) return;
    ::kill(pid_, SIGKILL);
    wait();
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  void send(int signal) const { ::kill(pid_, signal); }
  /// The exit code; -1 where a signal ended it.
  int wait() {
    int status = 0;
    ::waitpid(pid_, &status, 0);
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  std::string output() const { return read_text(out_); }
  std::string messages() const { return read_text(out_ + ".err"); }

 private:
  static inline int count_ = 0;
  std::string out_;
  pid_t pid_;
};

void wait_for_first_shard(const fs::path& sweep) {
  const Clock::time_point start = Clock::now();
  while (count_files(sweep / "shards") == 0 && seconds_since(start) < 30.0) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  REQUIRE(count_files(sweep / "shards") > 0);
}

void check_no_leftovers(const fs::path& sweep) {
  CHECK(count_files(sweep / "tmp") == 0);
  CHECK(count_files(sweep / "claims") == 0);
}

TEST_CASE("A signal ends a sweep soon and cleanly, and resume makes it whole", "[io][threads]") {
  const ProgramSweep& origin = get_slow_sweep();
  for (const int signal : {SIGINT, SIGTERM}) {
    const fs::path sweep = origin.copy("stopped");
    Child child("run", sweep, "2");
    wait_for_first_shard(sweep);
    const Clock::time_point start = Clock::now();
    child.send(signal);
    CHECK(child.wait() == 128 + signal);
    CHECK(seconds_since(start) < 2.0);
    CHECK(parse_json(child.output()).get<bool>("interrupted"));
    CHECK_THAT(child.messages(), Contains("interrupted") && Contains("strut run"));
    CHECK(count_files(sweep / "shards") < 6);
    check_no_leftovers(sweep);
    CHECK(test::verify_by_program(sweep).damaged.empty());

    CHECK(run_sweep_command("resume", sweep).code == 0);
    origin.check_whole(sweep);
    check_no_leftovers(sweep);
  }
}

TEST_CASE("A signal that was ignored on entry does not stop a sweep, another does",
          "[io][threads]") {
  for (const auto& [signals, code] : {std::pair("-INT", 0), std::pair("-TERM", 143)}) {
    const fs::path sweep = get_slow_sweep().copy("background");
    // A shell starts what runs behind & with SIGINT ignored.
    const Outcome outcome = test::run_shell(
        "sh -c '" STRUT_PROGRAM " run " + sweep.string() +
        " --threads 1 >/dev/null & pid=$!; while [ -z \"$(ls " + (sweep / "shards").string() +
        ")\" ]; do sleep 0.01; done; kill " + signals + " $pid; wait $pid'");
    CHECK(outcome.code == code);
    if (code == 0) get_slow_sweep().check_whole(sweep);
  }
}

TEST_CASE("Two processes on one folder share the work", "[io]") {
  const ProgramSweep& origin = get_slow_sweep();
  const fs::path sweep = origin.copy("shared");
  Child first("run", sweep, "1"), second("run", sweep, "1");
  CHECK(first.wait() == 0);
  CHECK(second.wait() == 0);
  const JsonTree one = parse_json(first.output()), other = parse_json(second.output());
  CHECK(one.get<int>("written") > 0);
  CHECK(other.get<int>("written") > 0);
  CHECK(one.get<int>("written") + other.get<int>("written") == 48);
  CHECK(one.get<int>("duplicates") + other.get<int>("duplicates") == 0);
  for (const JsonTree& json : {one, other}) {
    const int told =
        json.get<int>("present") + json.get<int>("written") + json.get<int>("elsewhere");
    CHECK(told == json.get<int>("cases"));
  }
  origin.check_whole(sweep);
  check_no_leftovers(sweep);
}

TEST_CASE("Wrong arguments of run are refused with what is allowed", "[io]") {
  const fs::path sweep = get_quick_sweep().copy("refused");
  const struct {
    const char* options;
    const char *what, *allowed;
  } kWrong[] = {{"--threads 0", "--threads = 0", "[1, 4096]"},
                {"--threads x", "--threads = x", "[1, 4096]"},
                {"--threads 1.5", "--threads = 1.5", "whole number"},
                {"--shards 5:3", "--shards 5:3", "0 <= A < B <= 10"},
                {"--shards 0:999", "--shards 0:999", "0 <= A < B <= 10"},
                {"--shards 3", "--shards 3", "A:B"},
                {"--shards :x", "--shards :x", "A:B"},
                {"--isa none", "--isa = none", "baseline"},
                {"--lease 0", "--lease = 0", "[1, 86400] s"},
                {"--thread 2", "--thread", "did you mean '--threads'?"},
                {"other", "2 arguments", "DIR"}};
  for (const auto& wrong : kWrong) {
    const Outcome outcome = run_sweep_command("run", sweep, wrong.options);
    INFO(wrong.options);
    CHECK(outcome.code == 2);
    CHECK(outcome.out.empty());
    CHECK_THAT(outcome.messages, Contains(wrong.what) && Contains(wrong.allowed));
  }
  CHECK(count_files(sweep / "shards") == 0);
}

TEST_CASE("A folder that is no sweep, or was edited, is refused by every command", "[io]") {
  const ProgramSweep& origin = get_quick_sweep();
  const fs::path edited = origin.copy("edited"), empty = origin / "empty";
  fs::create_directories(empty);
  std::string text = read_text(edited / "request.toml");
  text.replace(text.find("35500"), 5, "37000");
  std::ofstream(edited / "request.toml") << text;
  for (const char* command : {"run", "resume", "status", "verify"}) {
    INFO(command);
    CHECK_THAT(run_program(command).messages, Contains("DIR"));
    for (const fs::path& folder : {empty, origin / "nowhere", edited / "plan.h5"}) {
      const Outcome none = run_sweep_command(command, folder);
      CHECK(none.code == 2);
      CHECK_THAT(none.messages, Contains(folder.string()) && Contains("strut plan"));
    }
    const Outcome changed = run_sweep_command(command, edited);
    CHECK(changed.code == 2);
    CHECK_THAT(changed.messages,
               Contains("request.toml") && Contains("grid[1]: was") && Contains("allowed"));
  }
}

TEST_CASE("Run, status and verify tell scripts the agreed keys", "[io]") {
  const fs::path sweep = get_quick_sweep().copy("scripts");
  JsonTree status = parse_json(run_sweep_command("status", sweep, "--json").out);
  CHECK(status.get<int>("left") == 48);
  CHECK(status.get<std::string>("rate_per_s") == "null");
  CHECK(status.get<std::string>("seconds_left") == "null");
  CHECK(!status.get<bool>("complete"));
  const Outcome incomplete = run_sweep_command("verify", sweep, "--json");
  CHECK(incomplete.code == 1);
  CHECK(parse_json(incomplete.out).get<int>("missing") == 48);

  const JsonTree run = parse_json(run_sweep_command("run", sweep, "--shards 2:4 --json").out);
  CHECK(run.get<int>("cases") == 10);
  CHECK(run.get<int>("written") == 10);
  CHECK(run.get<double>("runs_per_s") > 0.0);
  CHECK(run.get<double>("thread_seconds.integrate") > 0.0);
  CHECK(!run.get<bool>("interrupted"));
  CHECK(run_sweep_command("run", sweep).code == 0);

  status = parse_json(run_sweep_command("status", sweep, "--json").out);
  CHECK(status.get<int>("cases") == 48);
  CHECK(status.get<int>("done") == 48);
  CHECK(status.get<int>("failed") == 0);
  CHECK(status.get<int>("running") == 0);
  CHECK(status.get<bool>("complete"));
  const JsonTree verdict = parse_json(run_sweep_command("verify", sweep, "--sample 3 --json").out);
  CHECK(verdict.get<bool>("ok"));
  CHECK(verdict.get<std::string>("data_digest") == status.get<std::string>("data_digest"));
  CHECK(verdict.get<int>("cases") == 48);
  CHECK(verdict.get<int>("missing") + verdict.get<int>("double") + verdict.get<int>("foreign") ==
        0);
  CHECK(verdict.get_child("damaged").empty());
  CHECK(verdict.get<int>("resimulated") == 3);
}

TEST_CASE("Cases that fail are data: exit code 1, and status says why", "[io]") {
  const ProgramSweep& origin = get_quick_sweep();
  std::ofstream(origin / "failing.toml") << test::make_failing_sweep();
  const fs::path sweep = origin / "failing";
  REQUIRE(
      run_program("plan " + (origin / "failing.toml").string() + " -o " + sweep.string()).code ==
      0);
  const Outcome outcome = run_sweep_command("run", sweep);
  CHECK(outcome.code == 1);
  CHECK_THAT(outcome.out, Contains("24 cases simulated") && Contains("failed") &&
                              Contains("impossible: ") && Contains("no_equilibrium: "));
  CHECK(run_sweep_command("run", sweep, "--allow-failed").code == 0);
  const Outcome told = run_sweep_command("status", sweep);
  CHECK(told.code == 1);
  CHECK_THAT(told.out, Contains("impossible: ") && Contains("no_equilibrium: "));
  const JsonTree status = parse_json(run_sweep_command("status", sweep, "--json").out);
  CHECK(status.get<int>("failed") ==
        status.get<int>("failures.impossible") + status.get<int>("failures.no_equilibrium"));
  CHECK(status.get<int>("done") + status.get<int>("failed") == 24);
  CHECK(status.get<int>("done") > 0);

  // The first failed case of each reason fails alone with the same words.
  for (const auto& [reason, first] : status.get_child("first_failures")) {
    std::string settings;
    for (const auto& [name, value] : first.get_child("parameters")) {
      settings += " --set " + name + "=" + value.get_value<std::string>();
    }
    const auto why = first.get<std::string>("why");
    INFO(reason + settings + ": " + why);
    CHECK_THAT(told.out, Contains(reason + ": " + status.get<std::string>("failures." + reason) +
                                  ", first case " + first.get<std::string>("case") + " with") &&
                             Contains(why));
    REQUIRE(!why.empty());
    const std::string inputs = (sweep / "request/").string();
    const Outcome alone =
        run_program("simulate " + inputs + "paper_sedan.toml " + inputs + "one_sided.toml" +
                    settings + " -o " + (origin / "alone.csv").string());
    CHECK(alone.code != 0);
    CHECK_THAT(alone.messages, Contains(why));
  }
  CHECK(status.get_child("first_failures").size() == status.get_child("failures").size());
  CHECK(run_sweep_command("verify", sweep, "--sample 24").code == 0);
}

TEST_CASE("A damaged shard is told by run and status, and does not stop the rest", "[io]") {
  const ProgramSweep& origin = get_quick_sweep();
  const fs::path sweep = origin.copy("damaged");
  REQUIRE(run_sweep_command("run", sweep, "--shards :5").code == 0);
  fs::remove(sweep / "journal");
  std::fstream shard(sweep / "shards/000003.h5", std::ios::in | std::ios::out | std::ios::binary);
  shard.seekp(4000);
  shard.put('\x55');
  shard.close();
  for (const char* command : {"run", "resume", "status"}) {
    const Outcome outcome = run_sweep_command(command, sweep);
    CHECK(outcome.code == 1);
    CHECK_THAT(outcome.messages, Contains("shards/000003.h5: damaged"));
  }
  CHECK(count_files(sweep / "shards") == 10);
  CHECK(run_sweep_command("verify", sweep, "--quarantine").code == 1);
  CHECK(run_sweep_command("run", sweep).code == 0);
  origin.check_whole(sweep);
}

}  // namespace
}  // namespace strut
