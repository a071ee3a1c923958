// Sweep folders that came from elsewhere: links, pipes and foreign files in place of the files that
// strut writes. Nothing outside the folder changes, nothing waits forever, and errors name the
// file.
#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "io/file/atomic_file.h"
#include "io/file/process_identity.h"
#include "tests/jobs/program_sweep.h"

namespace strut {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;
using test::Outcome;
using test::ProgramSweep;
using test::read_text;
using test::run_shell;
using test::run_sweep_command;

const ProgramSweep& get_sweep() {
  static const ProgramSweep sweep(test::make_coarse_sweep(12));
  return sweep;
}

/// Reads every file below a folder, by its path.
std::map<std::string, std::string> read_all(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    files[entry.path().string()] = entry.is_regular_file() ? read_text(entry.path()) : "";
  }
  return files;
}

/// A foreign folder with names that could be mistaken for ours.
fs::path make_victim(const std::string& name) {
  fs::path victim = get_sweep() / name;
  fs::remove_all(victim);
  fs::create_directory(victim);
  for (const char* file : {"thesis.tex", "000000.h5", "000000", "host.1.0123456789abcdef.0",
                           "runner.host.1.0123456789abcdef", "new.x.0"}) {
    std::ofstream(victim / file) << "mine";
  }
  return victim;
}

Outcome run_with_limit(const std::string& words) {
  return run_shell("timeout -s KILL 60 " STRUT_PROGRAM " " + words);
}

TEST_CASE("No command writes or deletes through a link that takes a subfolder's place", "[io]") {
  const std::vector<std::string> subfolders = {"tmp",        "claims", "shards", "retries",
                                               "quarantine", "logs",   "request"};
  const fs::path victim = make_victim("victim");
  const auto before = read_all(victim);
  for (const std::string& subfolder : subfolders) {
    CAPTURE(subfolder);
    const fs::path sweep = get_sweep().copy("linked");
    if (subfolder == "request") {
      fs::rename(sweep / "request", sweep / "kept");
    } else {
      fs::remove_all(sweep / subfolder);
    }
    fs::create_symlink(subfolder == "request" ? sweep / "kept" : victim, sweep / subfolder);
    for (const std::string command : {"run", "resume"}) {
      CAPTURE(command);
      const Outcome outcome = run_sweep_command(command, sweep, "--threads 1");
      CHECK(outcome.code == 2);
      CHECK_THAT(outcome.messages, Contains(subfolder + ": a symbolic link"));
    }
    CHECK(read_all(victim) == before);
  }
}

TEST_CASE("Damaged files are moved aside only within the folder", "[io]") {
  const fs::path victim = make_victim("victim");
  const auto before = read_all(victim);
  const fs::path sweep = get_sweep().copy("damaged");
  REQUIRE(run_sweep_command("run", sweep, "--threads 1").code == 0);
  std::ofstream(sweep / "shards/000001.h5") << "garbage";
  fs::remove(sweep / "quarantine");
  fs::create_symlink(victim, sweep / "quarantine");
  const Outcome outcome = run_sweep_command("verify", sweep, "--quarantine");
  CHECK(outcome.code == 2);
  CHECK_THAT(outcome.messages, Contains("quarantine: a symbolic link"));
  CHECK(read_text(sweep / "shards/000001.h5") == "garbage");
  CHECK(read_all(victim) == before);
}

TEST_CASE("A journal that is a link is neither appended to nor replaced", "[io]") {
  const fs::path sweep = get_sweep().copy("journal");
  const fs::path theirs = get_sweep() / "bashrc";
  std::ofstream(theirs) << "alias ll='ls -l'\n";
  fs::create_symlink(theirs, sweep / "journal");
  const Outcome outcome = run_sweep_command("run", sweep, "--threads 1");
  CHECK(outcome.code == 2);
  CHECK_THAT(outcome.messages, Contains("journal: a symbolic link"));
  CHECK(read_text(theirs) == "alias ll='ls -l'\n");
  CHECK(fs::is_empty(sweep / "shards"));  // refused before any simulation
}

TEST_CASE("A run deletes only files with names of strut", "[io]") {
  const fs::path sweep = get_sweep().copy("foreign");
  const std::set<std::string> foreign = {"tmp/thesis.tex", "tmp/notes.1", "tmp/host.1.abc.0",
                                         "claims/readme",  "plan.h5.bak", "plan.h5.aaaaaa",
                                         "x-1-1-1.tmp"};
  for (const std::string& name : foreign) std::ofstream(sweep / name) << "mine";
  CHECK(run_sweep_command("run", sweep, "--threads 1").code == 0);
  for (const std::string& name : foreign) {
    CAPTURE(name);
    CHECK(fs::exists(sweep / name));
  }
}

TEST_CASE("The next run removes the files of killed processes from a sweep folder", "[io]") {
  const fs::path sweep = get_sweep().copy("killed");
  const ProcessIdentity own = find_own_identity();
  // No process has this number: the kernel assigns numbers below 2^22.
  const std::string dead = own.host + ".4194305.0123456789abcdef";
  const std::string identity = "host " + own.host + "\nboot " + own.boot + "\nnamespace " +
                               own.name_space +
                               "\nprocess 4194305\nstart 1\ncounter 00000000000000000000\n";
  std::vector<std::string> names = {"claims/new." + dead + ".0", "claims/new." + dead + ".1",
                                    "claims/new." + dead + ".2", "claims/000001~0123456789abcdef",
                                    "tmp/" + dead + ".0"};
  std::ofstream(sweep / names[0]) << "";            // killed before it wrote who it is
  std::ofstream(sweep / names[1]) << identity;      // before it named its runner's file
  std::ofstream(sweep / names[2]) << dead << "\n";  // before it named a claim
  std::ofstream(sweep / names[3]) << dead << "\n";  // while it took a claim over
  std::ofstream(sweep / names[4]) << "half a shard";
  {
    // The name that an earlier process with this number would have given.
    const AtomicFile file(Folder(sweep), "plan.h5");
    std::string name = file.temporary().filename().string();
    const std::string start = "-" + own.start + "-";
    REQUIRE(name.find(start) != std::string::npos);
    names.push_back(name.replace(name.find(start), start.size(), "-1-"));
    std::ofstream(sweep / names.back()) << "half a plan";
  }
  CHECK(run_sweep_command("run", sweep, "--threads 1").code == 0);
  for (const std::string& name : names) {
    CAPTURE(name);
    CHECK_FALSE(fs::exists(sweep / name));
  }
  get_sweep().check_whole(sweep);
}

TEST_CASE("Pipes, devices and dangling links in a sweep folder are refused with a message",
          "[io]") {
  struct Place {
    std::string file;
    std::vector<std::string> commands;  // that read or write it
  };
  const std::vector<Place> places = {
      {"journal", {"run", "status", "verify"}},
      {"plan.h5", {"run", "status", "verify", "merge -o DIR.merged.h5", "train -o DIR.model.h5"}},
      {"request.toml", {"run", "status"}},
      {"claims/000000", {"run", "status"}},
      {"shards/000001.h5", {"verify", "status", "merge -o DIR.merged.h5", "train -o DIR.model.h5"}},
  };
  const std::map<std::string, void (*)(const fs::path&)> kinds = {
      {"pipe", [](const fs::path& path) { REQUIRE(::mkfifo(path.c_str(), 0600) == 0); }},
      {"device", [](const fs::path& path) { fs::create_symlink("/dev/zero", path); }},
      {"dangling link", [](const fs::path& path) { fs::create_symlink("/nowhere/at/all", path); }}};
  for (const Place& place : places) {
    for (const auto& [kind, make] : kinds) {
      const fs::path sweep = get_sweep().copy("odd");
      fs::remove(sweep / place.file);
      make(sweep / place.file);
      for (std::string command : place.commands) {
        CAPTURE(place.file, kind, command);
        const auto at = command.find("DIR");
        if (at != std::string::npos) command.replace(at, 3, sweep.string());
        const auto space = command.find(' ');
        const Outcome outcome =
            run_with_limit(command.substr(0, space) + " " + sweep.string() +
                           (space == std::string::npos ? "" : command.substr(space)));
        const bool is_shard = place.file.starts_with("shards/");
        const bool is_report = command.starts_with("status") || command.starts_with("verify");
        // For readers, a dangling link is a missing journal.
        const bool is_missing = place.file == "journal" && kind == "dangling link" && is_report;
        if (is_missing) {
          CHECK(outcome.code <= 1);
          continue;
        }
        CHECK(outcome.code == (is_shard && is_report ? 1 : 2));
        const std::string stem = fs::path(place.file).stem();
        CHECK_THAT(outcome.out + outcome.messages, Contains(stem));
      }
    }
  }
}

TEST_CASE(
    "If two different plans are written to one folder at once, one wins and the other is refused",
    "[io]") {
  const fs::path a = get_sweep() / "a.toml", b = get_sweep() / "b.toml";
  std::ofstream(a) << test::make_coarse_sweep(12);
  std::ofstream(b) << test::make_coarse_sweep(16);
  const fs::path folder = get_sweep() / "raced";
  const auto plan = [&](const fs::path& file) {
    return STRUT_PROGRAM " plan " + file.string() + " -o " + folder.string();
  };
  for (int round = 0; round < 6; ++round) {
    fs::remove_all(folder);
    const Outcome outcome =
        run_shell("(" + plan(a) + "; echo a $?) & (" + plan(b) + "; echo b $?); wait");
    CAPTURE(outcome.out, outcome.messages);
    const bool a_won = outcome.out.find("a 0") != std::string::npos;
    const bool b_won = outcome.out.find("b 0") != std::string::npos;
    CHECK(a_won != b_won);
    // The folder belongs to the winner: planning it again changes nothing, the other is refused.
    CHECK(run_shell(plan(a)).code == (a_won ? 0 : 2));
    CHECK(run_shell(plan(b)).code == (b_won ? 0 : 2));
    CHECK(run_sweep_command("status", folder).code == 0);
  }
}

TEST_CASE("The doctor reports links in a sweep folder", "[io]") {
  const fs::path sweep = get_sweep().copy("examined");
  CHECK_THAT(run_sweep_command("doctor", sweep, "--to local").out, Contains("links inside: none"));
  fs::remove(sweep / "tmp");
  fs::create_symlink("/var/tmp", sweep / "tmp");
  const Outcome outcome = run_sweep_command("doctor", sweep, "--to local");
  CHECK(outcome.code == 1);
  CHECK_THAT(outcome.out, Contains("tmp -> /var/tmp"));
}

}  // namespace
}  // namespace strut
