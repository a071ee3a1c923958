// The program `strut`: runs the named command; the one place where exceptions become exit codes.

#include <fmt/format.h>
#include <sundials/sundials_version.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <system_error>

#include "base/text/build_info.h"
#include "base/text/nearest_name.h"
#include "io/format/hdf5.h"
#include "jobs/bench/find_example.h"
#include "jobs/cli/interrupt.h"
#include "jobs/cli/messages.h"
#include "jobs/cli/standard_output.h"
#include "jobs/commands.h"
#include "model/error/model_error.h"
#include "model/kernel/simulation.h"

namespace {

using strut::Command;

void print_help() {
  std::cout << "Usage: strut COMMAND [ARGUMENTS]\n\nCommands:\n";
  for (const Command& command : strut::list_commands()) {
    std::cout << fmt::format("  {:<12}{}\n", command.name, command.purpose);
  }
  std::cout << "\n`strut COMMAND --help` or `strut help COMMAND` explains a command; "
               "`strut --version` prints the\nversion. Every command has --quiet and --verbose.\n"
               "\nExit codes:\n";
  for (const strut::ExitMeaning& exit : strut::list_exit_meanings()) {
    std::cout << fmt::format("  {:<12}{}\n", exit.code, exit.meaning);
  }
}

void print_version() {
  const strut::BuildInfo& build = strut::get_build_info();
  std::cout << fmt::format("strut {} ({})\ncompiler: {}, {}\ninstruction sets:", build.version,
                           build.commit, build.compiler, build.build_type);
  for (const strut::Kernel& kernel : strut::list_kernels()) {
    std::cout << fmt::format(" {} ({} lanes)", kernel.isa, kernel.lanes);
  }
  char sundials[32] = "";
  SUNDIALSGetVersion(sundials, sizeof sundials);
  std::cout << fmt::format("\nHDF5: {}\nSUNDIALS: {}\n", strut::hdf5_version(), sundials);
}

/// The path of an example file; if it is not found, its path in the sources.
std::string name_example(const std::string& name) {
  try {
    const std::filesystem::path found = strut::find_example(name);
    const std::filesystem::path near = std::filesystem::proximate(found);
    return *near.begin() == ".." ? found.string() : near.string();
  } catch (const strut::InputError&) {
    return "examples/" + name;
  }
}

/// For `strut` without a command: suggests three to start with.
int suggest_first_commands() {
  strut::print_error("no command given; `strut --help` lists all commands; to start with:");
  strut::suggest_next({"strut", "simulate", name_example("vehicles/paper_sedan.toml"),
                       name_example("maneuvers/bump_20mps.toml"), "-o", "run.csv"},
                      "one car over one bump");
  strut::suggest_next({"strut", "plan", name_example("sweeps/paper_fast.toml"), "-o", "cars"},
                      "many cars, as training data of a network");
  strut::suggest_next(
      {"strut", "compare", name_example("extended_loop/campaign.toml"), "-o", "comparison"},
      "measured runs against simulated runs; docs/diagnosis.md");
  return strut::kExitInput;
}

int run_command(const Command& command, const std::vector<std::string>& words) {
  strut::Arguments arguments = command.describe();
  if (!arguments.parse(words)) return strut::kExitDone;
  if (arguments.is_on("quiet")) set_verbosity(strut::Verbosity::kQuiet);
  if (arguments.is_on("verbose")) set_verbosity(strut::Verbosity::kVerbose);
  strut::prepare_interrupt(arguments);
  const strut::BuildInfo& build = strut::get_build_info();
  strut::print_detail(fmt::format("version {} ({}), instruction set {}", build.version,
                                  build.commit, strut::list_kernels().front().isa));
  const strut::Stage stage("all of " + arguments.command());
  return command.run(arguments);
}

/// Refuses more than `max` words after `strut`.
void check_word_count(const std::vector<std::string>& words, std::size_t max) {
  if (words.size() <= max) return;
  throw strut::InputError(fmt::format("'{}' after '{}': one word too many; see strut --help",
                                      words[max], words[max - 1]));
}

int show_help(const std::vector<std::string>& words) {
  check_word_count(words, 2);
  if (words.size() > 1 && words[1] != "help") {
    return run_command(strut::find_command(words[1]), {"--help"});
  }
  print_help();
  return strut::kExitDone;
}

[[noreturn]] void refuse_option(const std::string& word) {
  std::vector<std::string> common;
  for (const strut::ArgumentOption& option : strut::Arguments::common_options()) {
    for (const std::string& name : {"--" + option.name, "-" + option.letter}) {
      common.push_back(name);
    }
  }
  const bool is_common = std::find(common.begin(), common.end(), word) != common.end();
  std::vector<std::string> all = {"--version"};
  all.insert(all.end(), common.begin(), common.end());
  throw strut::InputError(fmt::format(
      "option '{}' before the command: options follow it, as in strut COMMAND {}; see strut --help",
      word, is_common ? word : "--quiet" + strut::suggest_name(word, all)));
}

int run(const std::vector<std::string>& words) {
  if (words.empty()) return suggest_first_commands();
  const std::string& first = words.front();
  if (first == "--help" || first == "-h" || first == "help") return show_help(words);
  if (first == "--version") {
    check_word_count(words, 1);
    print_version();
    return strut::kExitDone;
  }
  if (first.starts_with("-")) refuse_option(first);
  return run_command(strut::find_command(first), {words.begin() + 1, words.end()});
}

int run_and_flush(const std::vector<std::string>& words) {
  const int code = run(words);
  if (!std::cout.flush()) {
    throw strut::EnvironmentError(
        "standard output: cannot be written; is the disk full, or has the reader exited?");
  }
  strut::print_suggestions();
  return code;
}

int fail(strut::ExitCode code, const std::string& text) {
  strut::print_error(text);
  return code;
}

/// For errors of the file system for which a command has no message of its own.
int fail_on_file(const std::filesystem::filesystem_error& error) {
  const std::string what = error.path1().string() + ": " + error.code().message();
  switch (error.code().value()) {
    case ENAMETOOLONG:
      return fail(strut::kExitInput, what + "; name another file or folder");
    case ELOOP:
      return fail(strut::kExitInput, what + "; its symbolic links form a circle");
    case ENOTDIR:
      return fail(strut::kExitInput, what + "; a file stands where a folder must be");
    case EACCES:
      return fail(strut::kExitEnvironment,
                  what + "; check the permissions of it and of the folders above it");
    default:
      return fail(strut::kExitEnvironment, what);
  }
}

int fail_on_system(const std::system_error& error) {
  const bool no_threads = error.code().value() == EAGAIN;
  const std::string remedy = "; fewer --threads or a higher process limit (ulimit -u) may help";
  return fail(strut::kExitEnvironment, error.what() + (no_threads ? remedy : ""));
}

int fail_on_bug(const std::string& what) {
  return fail(
      strut::kExitBug,
      fmt::format("a bug in strut: {}; please report this message, the command line and the "
                  "output of `strut --version`",
                  what));
}

}  // namespace

int main(int argc, char** argv) {
  strut::end_on_interrupt();
  // A write beyond a file size limit fails as on a full disk instead of ending the program.
  std::signal(SIGXFSZ, SIG_IGN);
  const strut::StandardOutput output;
  const std::vector<std::string> words(argv + 1, argv + argc);
  try {
    return run_and_flush(words);
  } catch (const strut::InputError& e) {
    return fail(strut::kExitInput, e.what());
  } catch (const strut::ModelError& e) {
    return fail(strut::kExitInput, e.what());
  } catch (const strut::EnvironmentError& e) {
    return fail(strut::kExitEnvironment, e.what());
  } catch (const std::filesystem::filesystem_error& e) {
    return fail_on_file(e);
  } catch (const std::system_error& e) {
    return fail_on_system(e);
  } catch (const std::bad_alloc&) {
    return fail(strut::kExitEnvironment, "out of memory");
  } catch (const std::exception& e) {
    return fail_on_bug(e.what());
  } catch (...) {
    return fail_on_bug("an unknown exception");
  }
}
