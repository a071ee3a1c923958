// The completion scripts, each in its own shell: commands, options, values and operands of every
// command's table.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <set>

#include "base/text/quote_word.h"
#include "jobs/commands.h"
#include "jobs/completion/scripts.h"
#include "jobs/completion/words.h"
#include "model_files/parameters.h"
#include "tests/jobs/check_hint.h"
#include "tests/jobs/run_program.h"
#include "tests/support/run_shell.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

using Catch::Matchers::Contains;
using test::Outcome;
using test::run_program;
using test::run_shell;
using test::split_lines;
using test::TemporaryFolder;

using Words = std::set<std::string>;

/// A command line without "strut", of which the last word is to be completed.
struct Query {
  std::vector<std::string> words;
  Words offers;  // expected
};

using Queries = std::vector<Query>;

const char* const kFiles[] = {"car.toml", "run.csv", "model.h5", "notes.txt"};

/// Makes a folder "files" of files to be offered.
void make_files(const TemporaryFolder& folder) {
  fs::create_directories(folder / "files/a folder");
  for (const char* name : kFiles) folder.write(std::string("files/") + name, "");
}

/// The files of make_files(), or other words, that complete a value.
Words list_offers(const ArgumentValue& value) {
  if (value.kind == ArgumentValue::Kind::kText) return {};
  if (value.kind == ArgumentValue::Kind::kChoice) return {value.words.begin(), value.words.end()};
  if (value.kind == ArgumentValue::Kind::kSetting) {
    Words settings;
    for (const ParameterInfo& parameter : list_parameters()) settings.insert(parameter.name + "=");
    return settings;
  }
  Words offers = {"a folder"};
  if (value.kind == ArgumentValue::Kind::kFolder) return offers;
  for (const std::string name : kFiles) {
    bool fits = value.endings.empty();
    for (const std::string& ending : value.endings) fits |= name.ends_with("." + ending);
    if (fits) offers.insert(name);
  }
  return offers;
}

Queries list_command_queries() {
  Queries queries = {{{"sim"}, {"simulate"}},
                     {{"help", "sim"}, {"simulate"}},
                     {{"--"}, {"--help", "--version"}},
                     {{"nonsense", ""}, {}}};
  for (const Command& command : list_commands()) {
    Words options;
    for (const ArgumentOption& option : list_all_options(command.describe())) {
      options.insert("--" + option.name);
    }
    queries.push_back({{command.name, "--"}, options});
    queries.push_back({{command.name, "--verb"}, {"--verbose"}});
  }
  return queries;
}

Queries list_value_queries() {
  Queries queries = {{{"simulate", "--integrator=ab"}, {"abm4"}},
                     {{"simulate", "--integrator="}, {"abm4", "cvode", "rk4"}},
                     {{"design", "car.toml", "--csv="}, {"a folder", "run.csv"}}};
  for (const Command& command : list_commands()) {
    for (const ArgumentOption& option : list_all_options(command.describe())) {
      if (option.is_switch || option.value.kind == ArgumentValue::Kind::kText) continue;
      for (const std::string& spelling : list_spellings(option)) {
        queries.push_back({{command.name, spelling, ""}, list_offers(option.value)});
      }
    }
  }
  return queries;
}

Queries list_operand_queries() {
  // Values of options are not operands: SWEEP.toml is still missing, MANEUVER.toml too.
  Queries queries = {{{"plan", "-o", "sweep", "c"}, {"car.toml"}},
                     {{"simulate", "car.toml", "--set", "mass=1", "c"}, {"car.toml"}}};
  for (const Command& command : list_commands()) {
    const Arguments arguments = command.describe();
    std::vector<std::string> words = {command.name};
    for (const ArgumentValue& operand : arguments.operands()) {
      words.emplace_back("");
      queries.push_back({words, list_offers(operand)});
      words.back() = "given";
    }
    words.emplace_back("");
    queries.push_back({words, arguments.last_operand_repeats()
                                  ? list_offers(arguments.operands().back())
                                  : Words{}});
  }
  return queries;
}

Words list_command_names() {
  Words names = {"help"};
  for (const Command& command : list_commands()) names.insert(command.name);
  return names;
}

/// Runs a command of the shell and splits its output into lines. Fails if it prints errors.
std::vector<std::string> run(const std::string& command) {
  const Outcome outcome = run_shell(command);
  INFO(outcome.messages);
  REQUIRE(outcome.code == 0);
  CHECK(outcome.messages.empty());
  return split_lines(outcome.out);
}

/// Bash breaks words at =.
std::vector<std::string> split_as_bash_does(const std::vector<std::string>& words) {
  std::vector<std::string> parts;
  for (const std::string& word : words) {
    const std::size_t equals = word.find('=');
    parts.push_back(word.substr(0, equals));
    if (equals == std::string::npos) continue;
    parts.emplace_back("=");
    if (equals + 1 < word.size()) parts.push_back(word.substr(equals + 1));
  }
  return parts;
}

Words complete_in_bash(const TemporaryFolder& folder, const std::vector<std::string>& words) {
  const std::vector<std::string> parts = split_as_bash_does(words);
  std::string line = "cd " + quote_word(folder / "files") + "; source " +
                     quote_word(folder / "strut.bash") + "; COMP_WORDS=(strut";
  for (const std::string& part : parts) line += " " + quote_word(part);
  line += "); COMP_CWORD=" + std::to_string(parts.size()) +
          "; _strut; ((${#COMPREPLY[@]} == 0)) || printf '%s\\n' \"${COMPREPLY[@]}\"";
  const std::vector<std::string> lines = run("bash --norc -c " + quote_word(line));
  return {lines.begin(), lines.end()};
}

void check_in_bash(const Queries& queries) {
  const TemporaryFolder folder;
  make_files(folder);
  folder.write("strut.bash", make_bash_completion(list_commands()));
  for (const Query& query : queries) {
    CAPTURE(query.words);
    CHECK(complete_in_bash(folder, query.words) == query.offers);
  }
}

/// Completes one line for each query in one process of the shell: `command` reads the lines from
/// the file "lines" and prints the offers for each as one line, separated by tabs.
std::vector<Words> complete_all(const TemporaryFolder& folder, const Queries& queries,
                                const std::string& command) {
  std::string text;
  for (const Query& query : queries) {
    text += "strut";
    for (const std::string& word : query.words) text += " " + word;
    text += "\n";
  }
  folder.write("lines", text);
  const std::vector<std::string> lines = run(command);
  REQUIRE(lines.size() == queries.size());
  std::vector<Words> all;
  for (const std::string& line : lines) {
    std::istringstream stream(line);
    Words offers;
    for (std::string offer; std::getline(stream, offer, '\t');) {
      if (!offer.empty()) offers.insert(offer);
    }
    all.push_back(std::move(offers));
  }
  return all;
}

/// Whether the shell is installed; a warning says so if it is not.
bool is_installed(const std::string& shell) {
  if (run_shell("command -v " + shell).code == 0) return true;
  WARN(shell << " is not installed: its completion script is not tested");
  return false;
}

void check_in_zsh(const Queries& queries) {
  const TemporaryFolder folder;
  make_files(folder);
  folder.write("strut.zsh", make_zsh_completion(list_commands()));
  const std::vector<Words> all = complete_all(
      folder, queries,
      STRUT_SOURCE_DIR "/tests/jobs/complete_in_zsh " + quote_word(folder / "strut.zsh") + " " +
          quote_word(folder / "lines") + " " + quote_word(folder / "files"));
  for (std::size_t i = 0; i < queries.size(); ++i) {
    CAPTURE(queries[i].words);
    Words offers = all[i];
    // Without operands left, zsh offers the options.
    if (!queries[i].words.back().starts_with("-")) {
      std::erase_if(offers, [](const std::string& offer) { return offer.starts_with("-"); });
    }
    CHECK(offers == queries[i].offers);
  }
}

void check_in_fish(const Queries& queries) {
  const TemporaryFolder folder;
  make_files(folder);
  folder.write("strut.fish", make_fish_completion(list_commands()));
  const std::string script =
      "source " + (folder / "strut.fish").string() + "; cd " + (folder / "files").string() +
      "; while read -l line; set -l offers (complete " +
      "-C $line | string split -f 1 \\t); echo (string join \\t -- $offers); end < " +
      (folder / "lines").string();
  const std::vector<Words> all =
      complete_all(folder, queries, "fish --no-config -c " + quote_word(script));
  for (std::size_t i = 0; i < queries.size(); ++i) {
    CAPTURE(queries[i].words);
    // Fish repeats "--option=" before each value, and marks folders.
    const std::string& last = queries[i].words.back();
    const std::size_t prefix = last.starts_with("--") ? last.find('=') + 1 : 0;
    Words offers;
    for (std::string offer : all[i]) {
      if (offer.ends_with('/')) offer.pop_back();
      offers.insert(offer.substr(prefix));
    }
    CHECK(offers == queries[i].offers);
  }
}

TEST_CASE("Bash completes commands and their options", "[io]") {
  Words first = list_command_names();
  first.insert({"--help", "--version"});
  check_in_bash({{{""}, first}});
  check_in_bash(list_command_queries());
}

TEST_CASE("Bash completes the values of options", "[io]") { check_in_bash(list_value_queries()); }

TEST_CASE("Bash completes operands", "[io]") { check_in_bash(list_operand_queries()); }

TEST_CASE("Zsh completes commands, options and their values, and operands", "[io]") {
  if (!is_installed("zsh")) return;
  check_in_zsh({{{""}, list_command_names()}});
  check_in_zsh(list_command_queries());
  check_in_zsh(list_value_queries());
  check_in_zsh(list_operand_queries());
}

TEST_CASE("Fish completes commands, options and their values, and operands", "[io]") {
  if (!is_installed("fish")) return;
  check_in_fish({{{""}, list_command_names()}});
  check_in_fish(list_command_queries());
  check_in_fish(list_value_queries());
  check_in_fish(list_operand_queries());
}

TEST_CASE("A shell that strut cannot complete for is refused with those that it can", "[io]") {
  for (const char* shell : {"bash", "zsh", "fish"}) {
    CHECK(run_program("completion " + std::string(shell)).code == 0);
  }
  const Outcome wrong = run_program("completion fishy");
  CHECK(wrong.code == 2);
  CHECK(wrong.out.empty());
  CHECK_THAT(wrong.messages, Contains("unknown shell 'fishy'; must be one of bash, zsh, fish") &&
                                 Contains("did you mean 'fish'?"));
  for (const char* words : {"", " bash zsh"}) {
    const Outcome outcome = run_program("completion" + std::string(words));
    CHECK(outcome.code == 2);
    CHECK_THAT(outcome.messages, Contains("expected SHELL, one of bash, zsh, fish"));
  }
}

}  // namespace
}  // namespace strut
