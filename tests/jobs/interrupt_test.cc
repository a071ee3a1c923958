// Signals: what was ignored stays so, nothing is left behind, and the last words are said.
#include "jobs/cli/interrupt.h"

#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <thread>

#include "base/text/quote_word.h"
#include "tests/jobs/check_hint.h"
#include "tests/support/run_shell.h"

namespace strut {
namespace {

using test::Outcome;
using test::run_shell;
using test::TemporaryFolder;

const std::string kSedan = STRUT_SOURCE_DIR "/examples/vehicles/paper_sedan.toml";
const std::string kBump = STRUT_SOURCE_DIR "/examples/maneuvers/bump_20mps.toml";

void sleep_for(double seconds) {
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

/// A child whose work does not stop on its own: what it says on standard error, and its exit code.
Outcome interrupt_stubborn_work(int signals) {
  int pipe[2];
  REQUIRE(::pipe(pipe) == 0);
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    ::dup2(pipe[1], STDERR_FILENO);
    set_interrupt_message("the last words\n");
    const InterruptWatcher watcher;
    if (::write(pipe[1], "!", 1) == 1) sleep_for(20.0);
    ::_exit(0);
  }
  ::close(pipe[1]);
  Outcome outcome;
  char letter = 0;
  REQUIRE(::read(pipe[0], &letter, 1) == 1);
  for (int i = 0; i < signals; ++i) {
    ::kill(child, SIGINT);
    sleep_for(0.3);
  }
  while (::read(pipe[0], &letter, 1) == 1) outcome.messages += letter;
  ::close(pipe[0]);
  int status = 0;
  ::waitpid(child, &status, 0);
  outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

TEST_CASE("Work that does not stop ends at a second signal, or after a while, with its last words",
          "[io]") {
  for (const int signals : {1, 2}) {
    const Outcome outcome = interrupt_stubborn_work(signals);
    CHECK(outcome.code == 130);
    CHECK(outcome.messages == "the last words\n");
  }
}

TEST_CASE("A signal that was ignored on entry does not end a command, another does", "[io]") {
  for (const auto& [signal, code] : {std::pair("INT", 0), std::pair("TERM", 143)}) {
    const TemporaryFolder folder;
    // Some minutes of driving take some seconds.
    const Outcome outcome =
        run_shell("(trap '' INT; " STRUT_PROGRAM " simulate " + kSedan + " " + kBump +
                  " --rate 1 --set duration=100 -o " + (folder / "run.csv").string() +
                  " & pid=$!; sleep 0.3; kill -s " + signal + " $pid; wait $pid)");
    CHECK(outcome.code == code);
  }
}

TEST_CASE("A doctor that is interrupted leaves nothing in the folder", "[io]") {
  for (int delay = 2; delay <= 60; delay += 2) {
    const TemporaryFolder folder;
    INFO(delay << " ms");
    const Outcome outcome =
        run_shell("timeout --preserve-status -s INT " + std::to_string(1e-3 * delay) +
                  " " STRUT_PROGRAM " doctor --to local " + quote_word(folder / "."));
    CHECK((outcome.code == 0 || outcome.code == 130));
    CHECK(folder.file_count() == 0);
  }
}

TEST_CASE("A benchmark that is interrupted leaves nothing in the scratch folder", "[io][slow]") {
  const TemporaryFolder folder, scratch;
  const std::string log = folder / "log";
  const Outcome outcome =
      run_shell(STRUT_PROGRAM " bench --quick --scratch " + (scratch / ".").string() + " 2>" + log +
                " >/dev/null & pid=$!; until [ \"$(ls " + (scratch / ".").string() +
                ")\" ]; do sleep 0.01; kill -0 $pid || break; done; kill -TERM $pid; wait $pid");
  CHECK(outcome.code == 143);
  CHECK(scratch.file_count() == 0);
  CHECK_THAT(test::read_text(log),
             Catch::Matchers::Contains("strut: interrupted\nnext: strut bench"));
}

/// The program where no examples are above it.
std::string copy_program(const TemporaryFolder& folder) {
  std::filesystem::copy_file(STRUT_PROGRAM, folder / "strut");
  return "cd " + quote_word(folder / ".") + " && ./strut ";
}

TEST_CASE("A benchmark of a named car needs no examples", "[io][slow]") {
  const TemporaryFolder folder;
  const Outcome outcome =
      run_shell(copy_program(folder) + "bench --quick --json " + kSedan + " " + kBump);
  CHECK(outcome.code == 0);
  CHECK_THAT(outcome.messages, Catch::Matchers::Contains("no sweep is measured"));
  CHECK_THAT(outcome.out, Catch::Matchers::Contains("\"pipeline\": null"));
  const std::vector<std::string> words = test::check_hint(outcome.messages);
  CHECK(words[1] == "bench");
  CHECK(words[2] == kSedan);
}

TEST_CASE("A benchmark refuses before it measures", "[io]") {
  const TemporaryFolder folder;
  const std::string program = copy_program(folder);
  for (const std::string& command :
       {program + "bench -v", program + "bench -v --scratch nowhere " + kSedan + " " + kBump}) {
    INFO(command);
    const Outcome outcome = run_shell(command);
    CHECK(outcome.code == 2);
    CHECK_THAT(outcome.messages,
               !Catch::Matchers::Contains("measuring") && !Catch::Matchers::Contains("preparing"));
  }
}

}  // namespace
}  // namespace strut
