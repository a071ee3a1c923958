// Names and files of a folder reach a scheduler as words, never as commands, and never cause jobs
// of another folder to be stopped.
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include "base/error/input_error.h"
#include "base/text/quote_word.h"
#include "cluster/local.h"
#include "cluster/slurm.h"
#include "io/file/process_identity.h"
#include "tests/jobs/program_sweep.h"

namespace strut {
namespace {

namespace fs = std::filesystem;
using Catch::Contains;
using test::Outcome;
using test::ProgramSweep;
using test::run_sweep_command;

const ProgramSweep& get_sweep() {
  static const ProgramSweep sweep(test::make_coarse_sweep(16));
  return sweep;
}

Outcome run_in(const std::string& command, const fs::path& sweep, const std::string& options = "") {
  return test::run_shell("cd " + quote_word(sweep.parent_path().string()) +
                         " && " STRUT_PROGRAM " " + command + " -- " +
                         quote_word(sweep.filename().string()) + " " + options);
}

bool wait_until_complete(const fs::path& sweep) {
  for (int i = 0; i < 300; ++i) {
    const Outcome status = run_in("status --json", sweep);
    if (test::parse_json(status.out).get<bool>("complete", false)) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return false;
}

std::vector<std::string> list_words(const TaskArray& tasks) {
  return SlurmDispatcher().make_command(tasks, tasks.folder / "script.sh", {});
}

bool has_word(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

TEST_CASE("A folder with any name is submitted or refused, and no part of its name is executed",
          "[io]") {
  const std::string names[] = {"it's",
                               "a\"b",
                               "\\",
                               "%a-%j",
                               "-o",
                               "$(touch PWNED)",
                               "a;touch PWNED",
                               "a\ntouch PWNED",
                               "`touch PWNED`",
                               "a\"\n#SBATCH --wrap=\"touch PWNED"};
  for (const std::string& name : names) {
    CAPTURE(name);
    const fs::path sweep = get_sweep().copy("named") / ".." / "inner" / name;
    fs::create_directories(sweep.parent_path());
    fs::copy(get_sweep() / "named", sweep, fs::copy_options::recursive);
    const Outcome outcome = run_in("submit --to local --threads 1", sweep);
    CAPTURE(outcome.messages);
    CHECK((outcome.code == 0 || outcome.code == 2));
    CHECK(outcome.code == (has_control_character(name) ? 2 : 0));
    if (outcome.code == 0) CHECK(wait_until_complete(sweep));
    for (const fs::path& place : {sweep, sweep.parent_path(), fs::current_path()}) {
      CHECK_FALSE(fs::exists(place / "PWNED"));
    }
    fs::remove_all(sweep.parent_path());
  }
}

TEST_CASE("The words of sbatch do not depend on the name of the folder", "[unit]") {
  TaskArray tasks;
  tasks.name = "strut-1.array-0";
  tasks.tasks = 12;
  tasks.at_once = 3;
  tasks.mark = std::string(32, 'a');
  tasks.folder = "/sweeps/a\" --wrap=x %j/jobs/001";
  std::vector<std::string> words = list_words(tasks);
  CHECK(has_word(words, "--array=0-11%3"));
  CHECK(has_word(words, "--comment=" + tasks.mark));
  CHECK(has_word(words, "--output=/sweeps/a\" --wrap=x %%j/jobs/001/strut-1.array-0-%a.log"));
  CHECK_FALSE(has_word(words, "--wrap=x"));
  CHECK(words.back() == "/sweeps/a\" --wrap=x %j/jobs/001/script.sh");
  CHECK_THAT(SlurmDispatcher().make_script(tasks), !Contains("#SBATCH"));
  tasks.at_once = 0;
  tasks.folder = "/\\/%j";
  words = list_words(tasks);
  CHECK(has_word(words, "--array=0-11"));
  // Slurm replaces nothing in a pattern with a backslash.
  CHECK(has_word(words, "--output=/\\\\/%j/strut-1.array-0.log"));
}

/// A process in a session of its own, with STRUT_JOB unless `mark` is empty.
class Bystander {
 public:
  explicit Bystander(const std::string& mark) : pid_(::fork()) {
    REQUIRE(pid_ >= 0);
    if (pid_ == 0) {
      ::setsid();
      if (!mark.empty()) ::setenv("STRUT_JOB", mark.c_str(), 1);
      ::execlp("sleep", "sleep", "60", nullptr);
      ::_exit(1);
    }
    while (read_word(1) != "(sleep)") std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  ~Bystander() {
    if (!lives()) return;
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  Bystander(const Bystander&) = delete;
  Bystander& operator=(const Bystander&) = delete;

  bool lives() {
    has_ended_ = has_ended_ || ::waitpid(pid_, nullptr, WNOHANG) != 0;
    return !has_ended_;
  }

  /// Returns its name in the file of a submission.
  JobRecord make_record(const std::string& mark) const {
    const ProcessIdentity own = find_own_identity();
    constexpr int kStart = 21;  // man 5 proc
    return {"array-0",
            own.host + "/" + own.boot + "/" + own.name_space + "/" + std::to_string(pid_) + "/" +
                read_word(kStart),
            "strut-1.array-0", mark, "array-0.job"};
  }

 private:
  std::string read_word(int index) const {
    std::ifstream file("/proc/" + std::to_string(pid_) + "/stat");
    std::string word;
    for (int i = 0; i <= index; ++i) file >> word;
    return word;
  }

  pid_t pid_;
  bool has_ended_ = false;  // its number may have been reused
};

TEST_CASE("cancel stops only processes that bear the mark of the job", "[io]") {
  const std::string mark(32, 'b');
  const LocalDispatcher dispatcher;
  for (const std::string& other : {std::string(), std::string(32, 'c')}) {
    Bystander bystander(other);
    const JobRecord record = bystander.make_record(mark);
    CHECK_THROWS_WITH(dispatcher.cancel({record}),
                      Contains("cannot be proved to be job") && Contains("nothing is stopped"));
    CHECK_THAT(dispatcher.query({record}).failure, Contains("copied"));
    CHECK(bystander.lives());
  }
  Bystander job(mark);
  const Bystander foreign("");
  // If one of them is not proved, none is stopped.
  CHECK_THROWS_AS(dispatcher.cancel({job.make_record(mark), foreign.make_record(mark)}),
                  InputError);
  CHECK(job.lives());
  dispatcher.cancel({job.make_record(mark)});
  for (int i = 0; i < 200 && job.lives(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  CHECK_FALSE(job.lives());
}

TEST_CASE("Cancelling a copy of a folder does not stop the original sweep", "[io]") {
  static const ProgramSweep slow(test::make_coarse_sweep(8, "", "5e-5"));
  const fs::path sweep = slow.copy("running"), copy = slow / "copied";
  REQUIRE(run_sweep_command("submit", sweep, "--to local --threads 1").code == 0);
  fs::copy(sweep, copy, fs::copy_options::recursive);
  const Outcome cancelled = run_sweep_command("cancel", copy);
  const Outcome submitted = run_sweep_command("submit", copy, "--to local");
  CHECK(run_sweep_command("status", copy).code <= 1);
  CHECK(wait_until_complete(sweep));
  CHECK(cancelled.code == 3);
  CHECK_THAT(cancelled.messages, Contains("copied"));
  CHECK(submitted.code == 3);
}

TEST_CASE("A submission with more shards than the plan is refused", "[io]") {
  const fs::path sweep = get_sweep().copy("forged");
  REQUIRE(run_sweep_command("submit", sweep, "--to local --threads 1").code == 0);
  REQUIRE(wait_until_complete(sweep));
  const fs::path file = sweep / "jobs/001/submission.toml";
  const std::string text = test::read_text(file);
  for (const std::string shards : {"end = 1000000\nshards_a_task = 1\n",
                                   "end = 9007199254740992\nshards_a_task = "
                                   "9007199254740992\n"}) {
    std::ofstream(file) << text.substr(0, text.find("end = ")) << shards;
    for (const std::string task : {"0", "999999"}) {
      const Outcome outcome = run_sweep_command("run", sweep, "--task 001/0/" + task);
      CAPTURE(outcome.messages);
      CHECK(outcome.code == 2);
    }
  }
}

TEST_CASE("Submitting never writes through a link inside a sweep", "[io]") {
  for (const char* place : {"jobs", "jobs/001/array-0", "logs"}) {
    CAPTURE(place);
    const fs::path sweep = get_sweep().copy("linked"), elsewhere = get_sweep() / "elsewhere";
    fs::remove_all(elsewhere);
    fs::create_directory(elsewhere);
    const bool is_task = std::string(place).ends_with("array-0");
    if (is_task) {
      REQUIRE(run_sweep_command("submit", sweep, "--to local --threads 1").code == 0);
      REQUIRE(wait_until_complete(sweep));
      fs::remove_all(sweep / "shards");
      fs::remove(sweep / "journal");
    }
    fs::remove_all(sweep / place);
    fs::create_directory_symlink(elsewhere, sweep / place);
    const Outcome outcome = is_task ? run_sweep_command("run", sweep, "--task 001/0/0")
                                    : run_sweep_command("submit", sweep, "--to local");
    CHECK(outcome.code == 2);
    CHECK_THAT(outcome.messages, Contains("symbolic link"));
    CHECK(fs::is_empty(elsewhere));
  }
}

}  // namespace
}  // namespace strut
