// Conventions of all commands: one table of arguments for help and manual page, --quiet and
// --verbose, and a suggested next command.
#include <catch2/catch.hpp>
#include <filesystem>

#include "base/text/quote_word.h"
#include "jobs/cli/progress.h"
#include "jobs/commands.h"
#include "jobs/man_page.h"
#include "tests/jobs/check_hint.h"
#include "tests/jobs/program_sweep.h"
#include "tests/jobs/run_program.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

using Catch::Matchers::Contains;
using test::check_hint;
using test::Outcome;
using test::read_text;
using test::run_program;
using test::run_shell;
using test::split_as_bash;
using test::split_lines;
using test::TemporaryFolder;

const std::string kExamples = STRUT_SOURCE_DIR "/examples/";
const std::string kSedan = kExamples + "vehicles/paper_sedan.toml";
const std::string kBump = kExamples + "maneuvers/bump_20mps.toml";

std::vector<ArgumentOption> list_all_options(const Arguments& arguments) {
  std::vector<ArgumentOption> all = arguments.options();
  const std::vector<ArgumentOption>& common = Arguments::common_options();
  all.insert(all.end(), common.begin(), common.end());
  return all;
}

TEST_CASE("The help lists every command, and each command prints its own help", "[io]") {
  const std::string all = run_program("--help").out;
  for (const Command& command : list_commands()) {
    INFO(command.name);
    CHECK_THAT(all, Contains("\n  " + std::string(command.name) + " "));
    const Arguments arguments = command.describe();
    CHECK(arguments.command() == command.name);
    CHECK_FALSE(arguments.examples().empty());
    const Outcome outcome = run_program("help " + std::string(command.name));
    CHECK(outcome.code == 0);
    CHECK(outcome.messages.empty());
    CHECK_THAT(outcome.out, Contains("Usage: " + arguments.synopsis()) &&
                                Contains("Examples:\n" + arguments.examples()));
    for (const ArgumentOption& option : list_all_options(arguments)) {
      CHECK_THAT(outcome.out, Contains("--" + option.name + " "));
      for (const std::string& word : option.value.words) CHECK_FALSE(word.empty());
    }
    CHECK(run_program(std::string(command.name) + " --help").out == outcome.out);
  }
  CHECK_THAT(run_program("help simulat").messages, Contains("did you mean 'simulate'?"));
}

TEST_CASE("Without a command, three are suggested to start with", "[unit][io]") {
  const Outcome outcome = run_program("");
  CHECK(outcome.code == 2);
  CHECK(outcome.out.empty());
  std::vector<std::string> lines = split_lines(outcome.messages);
  REQUIRE(lines.size() == 4);
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const std::vector<std::string> words = split_as_bash(lines[i]);
    REQUIRE(words.size() > 3);
    CHECK_NOTHROW(find_command(words[2]));
    CHECK(fs::exists(words[3]));
  }
}

TEST_CASE("An invalid choice is refused with the allowed words", "[io]") {
  for (const Command& command : list_commands()) {
    const Arguments table = command.describe();
    for (const ArgumentOption& option : table.options()) {
      if (option.value.kind != ArgumentValue::Kind::kChoice) continue;
      Arguments arguments = command.describe();
      INFO(command.name << " --" << option.name);
      REQUIRE(arguments.parse({"--" + option.name, "nonsense"}));
      for (const std::string& word : option.value.words) {
        CHECK_THROWS_WITH(arguments.choice_or(option.name, 0), Contains(word));
        Arguments right = command.describe();
        REQUIRE(right.parse({"--" + option.name + "=" + word}));
        CHECK(option.value.words[static_cast<std::size_t>(right.choice_or(option.name, -1))] ==
              word);
      }
    }
  }
}

TEST_CASE("The manual page has every command and option, and groff reports no problem", "[io]") {
  const TemporaryFolder folder;
  const std::string file = folder.write("strut.1", make_man_page(list_commands()));
  CHECK(run_program("man").out == read_text(file));
  const Outcome outcome = run_shell("groff -man -Tascii -P-cbou -ww -rLL=200n " + file);
  if (outcome.code != 0 || outcome.out.empty()) FAIL("no groff: " + outcome.messages);
  CHECK(outcome.messages.empty());
  for (const char* section : {"NAME", "SYNOPSIS", "COMMANDS", "EXIT STATUS", "EXAMPLES"}) {
    CHECK_THAT(outcome.out, Contains("\n" + std::string(section) + "\n"));
  }
  for (const ExitMeaning& exit : list_exit_meanings()) {
    CHECK_THAT(outcome.out, Contains(exit.meaning));
  }
  for (const Command& command : list_commands()) {
    const std::size_t begin = outcome.out.find("   strut " + std::string(command.name) + "\n");
    REQUIRE(begin != std::string::npos);
    const std::size_t end = outcome.out.find("\n   strut ", begin);
    const std::string section = outcome.out.substr(begin, end - begin);
    INFO(section);
    const Arguments arguments = command.describe();
    for (const ArgumentOption& option : arguments.options()) {
      const std::string value = option.is_switch ? "" : " " + option.value.name;
      CHECK_THAT(section, Contains("--" + option.name + value));
    }
    CHECK_THAT(section, Contains("Examples:"));
  }
  CHECK_THAT(outcome.out, Contains("--quiet") && Contains("--verbose"));
}

struct HintCase {
  std::string command;  // after "strut "
  int code;
  std::string hint;  // first words of the suggestion
};

std::string join(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) line += (line.empty() ? "" : " ") + word;
  return line;
}

void check_case(const HintCase& c) {
  INFO(c.command);
  const Outcome outcome = run_program(c.command);
  CHECK(outcome.code == c.code);
  CHECK_THAT(join(check_hint(outcome.messages)), Catch::Matchers::StartsWith(c.hint));
}

/// Checks that the suggestion is exactly `c.hint`. Returns the messages.
std::string check_whole_hint(const HintCase& c) {
  INFO(c.command);
  const Outcome outcome = run_program(c.command);
  CHECK(outcome.code == c.code);
  CHECK(join(check_hint(outcome.messages)) == c.hint);
  return outcome.messages;
}

/// Plans a sweep in the folder "sweep" of `folder`.
std::string plan_sweep(const TemporaryFolder& folder, const std::string& text) {
  std::string sweep = folder / "sweep";
  REQUIRE(run_program("plan " + folder.write("sweep.toml", text).string() + " -o " + sweep).code ==
          0);
  return sweep;
}

/// A sweep of 32 cases of which half exceed the travel of their suspension, with any step.
std::string make_rough_sweep() {
  std::string text = test::make_coarse_sweep(16);
  const std::string axis = "rear_damping    = { from = 1980,  to = 1800,  step = -90 }";
  text.replace(text.find(axis), axis.size(), "bump_height = { from = 0.05, to = 0.19, count = 2 }");
  return text;
}

TEST_CASE("Commands of a sweep suggest the next one, up to the use of the network", "[io]") {
  const TemporaryFolder folder;
  const std::string text = test::make_coarse_sweep(12);
  const std::string file = folder.write("sweep.toml", text);
  const std::string raw = folder / "a sweep", sweep = quote_word(raw);
  const std::string merged = folder / "all.h5", model = folder / "model.h5";
  const std::string inputs = " --inputs body_position_z,pitch_rate --hidden 2 --allow-few --seed 1";
  const HintCase cases[] = {
      {"plan " + file + " --dry-run", 0, "strut plan " + file + " -o cars"},
      {"plan " + file + " -o " + sweep, 0, "strut run " + raw},
      {"status " + sweep, 0, "strut run " + raw},
      {"submit " + sweep + " --to local --dry-run", 0, "strut submit " + raw + " --to local"},
      {"cancel " + sweep, 0, "strut status " + raw},
      {"verify " + sweep, 1, "strut run " + raw},
      {"doctor " + sweep + " --to local", 0, "strut run " + raw},
      {"run " + sweep + " --shards 0:1", 0, "strut status " + raw},
      {"run " + sweep, 0, "strut verify " + raw},
      {"resume " + sweep + " --json", 0, "strut verify " + raw},
      {"status " + sweep + " --json", 0, "strut verify " + raw},
      {"submit " + sweep + " --to local", 0, "strut verify " + raw},
      {"verify " + sweep, 0, "strut train " + raw + " -o model.h5"},
      {"report " + sweep, 0, "xdg-open " + raw + "/report.html"},
      {"merge " + sweep + " -o " + merged, 0, "strut train " + merged},
      {"train " + merged + " -o " + model + inputs, 0, "strut identify " + model},
      {"evaluate " + model + " " + sweep, 0, "strut identify " + model},
      {"identify " + model + " --set body_position_z=9 --set pitch_rate=9", 1, "strut plan"},
      {"export " + model + " -o " + (folder / "m.onnx").string(), 0, "python3 -c"},
      {"export " + model + " -o " + (folder / "m.h").string(), 0, "cc -x c"},
      {"export " + model + " -o " + (folder / "m.c").string(), 0, "cc -c"},
  };
  for (const HintCase& c : cases) check_case(c);
}

TEST_CASE("After failed cases and damage, the command that repairs them is suggested", "[io]") {
  const TemporaryFolder folder;
  const std::string sweep = plan_sweep(folder, make_rough_sweep());
  const std::string verify = "strut verify " + sweep;
  check_whole_hint({"run " + sweep, 1, "strut resume " + sweep});
  check_whole_hint({"status " + sweep, 1, "strut resume " + sweep});
  CHECK_THAT(check_whole_hint({"resume " + sweep, 1, verify}), Contains("16 cases remain failed"));
  check_whole_hint({"status " + sweep, 1, verify});
  check_whole_hint({"run " + sweep, 1, verify});
  check_case({"verify " + sweep, 0, "strut train " + sweep});
  fs::resize_file(folder / "sweep/shards/000001.h5", 1000);
  check_case({"verify " + sweep, 1, "strut verify " + sweep + " --quarantine"});
  check_case({"verify " + sweep + " --quarantine", 1, "strut run " + sweep});
}

/// Follows the suggestions from `command` on and returns the names of the commands, up to train.
std::vector<std::string> follow_hints(std::string command) {
  std::vector<std::string> names;
  while (names.size() < 8) {
    const std::vector<std::string> words = check_hint(run_program(command).messages);
    names.push_back(words[1]);
    if (words[1] == "train") break;
    command.clear();
    for (std::size_t i = 1; i < words.size(); ++i) command += quote_word(words[i]) + " ";
  }
  return names;
}

TEST_CASE("Suggestions lead from a sweep to the network, whatever fails or is damaged", "[io]") {
  using Names = std::vector<std::string>;
  const TemporaryFolder folder;
  const std::string sweep = plan_sweep(folder, make_rough_sweep());
  CHECK(follow_hints("status " + sweep) == Names{"run", "resume", "verify", "train"});
  CHECK(follow_hints("status " + sweep) == Names{"verify", "train"});
  fs::resize_file(folder / "sweep/shards/000001.h5", 1000);
  CHECK(follow_hints("verify " + sweep) == Names{"verify", "run", "verify", "train"});
  fs::copy_file(folder / "sweep/shards/000001.h5", folder / "sweep/shards/000009.h5");
  CHECK(follow_hints("verify " + sweep) == Names{"verify", "verify", "train"});
  fs::resize_file(folder / "sweep/retries/000001.0.h5", 1000);
  CHECK(follow_hints("status " + sweep) == Names{"verify", "run", "resume", "verify", "train"});
}

TEST_CASE("No resume is suggested if a smaller step repairs nothing", "[io]") {
  const TemporaryFolder folder;
  const std::string sweep = plan_sweep(folder, test::make_failing_sweep());
  CHECK_THAT(check_whole_hint({"run " + sweep, 1, "strut verify " + sweep}),
             Contains("remain failed; strut train leaves them out"));
  check_whole_hint({"status " + sweep, 1, "strut verify " + sweep});
}

TEST_CASE("For files that are not shards of a sweep, their removal is suggested", "[io]") {
  const TemporaryFolder folder;
  const std::string sweep = plan_sweep(folder, test::make_coarse_sweep(24));
  const std::string verify = "strut verify " + sweep;
  REQUIRE(run_program("run " + sweep).code == 0);
  fs::copy_file(folder / "sweep/shards/000001.h5", folder / "sweep/shards/000009.h5");
  check_whole_hint({"verify " + sweep, 1, verify + " --quarantine"});
  check_whole_hint({"verify " + sweep + " --quarantine", 1, verify});
  check_case({"verify " + sweep, 0, "strut train"});

  const fs::path record = folder / "sweep/jobs/001/submission.toml";
  fs::create_directories(record.parent_path());
  folder.write("sweep/jobs/001/submission.toml", "dispatcher = \n");
  const std::string messages = check_whole_hint({"status " + sweep, 1, "strut status " + sweep});
  CHECK_THAT(messages, Contains(record.string()) && Contains("move this file away"));
  fs::remove(record);
  check_whole_hint({"status " + sweep, 0, verify});
}

TEST_CASE("An interrupted sweep suggests once how to continue", "[io]") {
  const TemporaryFolder folder;
  const std::string sweep = plan_sweep(folder, test::make_coarse_sweep(8, "", "2e-5"));
  const Outcome outcome = run_shell(
      "timeout --preserve-status -s INT 0.4 " STRUT_PROGRAM " resume --threads 1 " + sweep);
  CHECK(outcome.code == 130);
  CHECK_THAT(outcome.messages,
             Contains("files written so far are complete\n") && !Contains("strut run"));
  CHECK(join(check_hint(outcome.messages)) == "strut resume --threads 1 " + sweep);
}

TEST_CASE("A failed run is suggested again with all its words but the value to change", "[io]") {
  const TemporaryFolder folder;
  const std::string file = folder / "run.csv", report = folder / "report";
  const std::string rest = "simulate " + kSedan + " " + kBump + " -o " + file +
                           " --set speed=19 --integrator abm4 --report " + report;
  for (const char* set : {" --set bump_height=0.19", " --set=bump_height=0.19"}) {
    check_whole_hint({rest + set, 1, "strut " + rest + " --set bump_height=VALUE"});
  }
  const std::string rig = "simulate " + kExamples + "rigs/quarter_car.toml " + kExamples +
                          "rigs/maneuvers/bump.toml -o " + file +
                          " --step 0.02 --set tire_stiffness=1e7";
  check_whole_hint({rig, 1, "strut " + rig + " --set NAME=VALUE"});
}

TEST_CASE("A setting replaces earlier settings of the same name", "[unit]") {
  Arguments arguments = find_command("simulate").describe();
  REQUIRE(arguments.parse({"a.toml", "--set", "mass=1", "--set=speed=3", "--set", "speeds=4"}));
  CHECK(join(arguments.words_with_setting("speed=5")) ==
        "a.toml --set mass=1 --set speeds=4 --set speed=5");
  CHECK(join(arguments.words_with_setting("mass=2")) ==
        "a.toml --set=speed=3 --set speeds=4 --set mass=2");
}

TEST_CASE("Options of names and values set each name at most once", "[unit]") {
  int lists = 0;
  for (const Command& command : list_commands()) {
    const Arguments table = command.describe();
    for (const ArgumentOption& option : table.options()) {
      if (!option.repeats || option.value.name.find('=') == std::string::npos) continue;
      INFO(command.name << " --" << option.name);
      const std::string word = "--" + option.name;
      Arguments doubled = command.describe(), different = command.describe();
      CHECK_THROWS_WITH(doubled.parse({word, "a=1", word, "b=1", word + "=a=2"}),
                        "--" + option.name + ": 'a' given twice; allowed: once");
      CHECK(different.parse({word, "a=1", word, "b=1"}));
      ++lists;
    }
  }
  CHECK(lists >= 7);
}

TEST_CASE("Words before a command, and after help and version, are refused", "[unit][io]") {
  const std::string overview = run_program("--help").out;
  CHECK(run_program("help help").out == overview);
  CHECK(run_program("help help").code == 0);
  CHECK(run_program("--help simulate").out == run_program("simulate --help").out);
  const std::pair<const char*, const char*> wrong[] = {
      {"--quiet simulate", "options follow it, as in strut COMMAND --quiet; see"},
      {"-v simulate", "options follow it, as in strut COMMAND -v; see"},
      {"--verson", "did you mean '--version'?"},
      {"--json status", "option '--json' before the command"},
      {"help simulate junk", "'junk' after 'simulate'"},
      {"--version junk", "'junk' after '--version'"},
  };
  for (const auto& [command, text] : wrong) {
    INFO(command);
    const Outcome outcome = run_program(command);
    CHECK(outcome.code == 2);
    CHECK(outcome.out.empty());
    CHECK_THAT(outcome.messages, Contains(text));
  }
}

TEST_CASE("Single runs suggest the next command", "[io]") {
  const TemporaryFolder folder;
  const std::string file = folder / "run.csv", curves = folder / "curves.csv";
  const std::string design = folder.write("sweep.toml", test::make_coarse_sweep(12));
  check_case({"simulate " + kSedan + " " + kBump + " -o " + file, 0, "strut plan SWEEP.toml"});
  check_case({"simulate --kinematics " + kSedan + " -o " + curves, 0,
              "strut simulate " + kSedan + " MANEUVER.toml"});
  check_case({"simulate " + kExamples + "rigs/quarter_car.toml " + kExamples +
                  "rigs/maneuvers/bump.toml --force -o " + file,
              0, "strut compare CAMPAIGN.toml"});
  check_case({"simulate " + kSedan + " " + kBump + " --set bump_height=0.19 --force -o " + file, 1,
              "strut simulate " + kSedan});
  check_case({"design " + design + " --rate 100", 0, "strut plan " + design});
}

TEST_CASE("Quiet prints only errors, verbose prints more, data is the same", "[io]") {
  const TemporaryFolder folder;
  const std::string run =
      "simulate " + kSedan + " " + kBump + " --force -o " + (folder / "run.csv").string();
  const Outcome plain = run_program(run), quiet = run_program(run + " --quiet"),
                verbose = run_program(run + " -v");
  CHECK(quiet.messages.empty());
  CHECK_THAT(plain.messages, Contains("3001 samples") && !Contains("integrator"));
  CHECK_THAT(verbose.messages,
             Contains("3001 samples") && Contains("integrator rk4") && Contains("all of simulate"));
  CHECK(quiet.out == plain.out);
  CHECK(verbose.out == plain.out);
  const Outcome failed = run_program(run + " -q --set bump_height=0.19");
  CHECK(failed.code == 1);
  CHECK(split_lines(failed.messages).size() == 1);
  CHECK_THAT(failed.messages, Contains("strut: the run failed"));
  const Outcome wrong = run_program(run + " -q --set bump_hight=0.19");
  CHECK(wrong.code == 2);
  CHECK_THAT(wrong.messages, Contains("bump_height"));
  CHECK(run_program(run + " -q -v").code == 2);
}

TEST_CASE("With quiet, commands of a sweep print only errors", "[io]") {
  const TemporaryFolder folder;
  const std::string file = folder.write("sweep.toml", test::make_coarse_sweep(12));
  const std::string sweep = folder / "sweep", model = folder / "model.h5";
  const std::string commands[] = {
      "plan " + file + " -o " + sweep,
      "run " + sweep + " --shards 0:1",
      "resume " + sweep,
      "status " + sweep,
      "verify " + sweep,
      "doctor " + sweep + " --to local",
      "merge " + sweep + " -o " + (folder / "all.h5").string(),
      "report " + sweep,
      "train " + sweep + " -o " + model +
          " --inputs body_position_z,pitch_rate --hidden 2 --allow-few --seed 1",
      "evaluate " + model + " " + sweep,
      "export " + model + " -o " + (folder / "model.c").string(),
      "design " + file + " --rate 100"};
  for (const std::string& command : commands) {
    INFO(command);
    const Outcome outcome = run_program(command + " --quiet");
    CHECK(outcome.code == 0);
    CHECK(outcome.messages.empty());
  }
  fs::resize_file(folder / "sweep/shards/000001.h5", 1000);
  const Outcome damaged = run_program("verify " + sweep + " -q");
  CHECK(damaged.code == 1);
  CHECK_THAT(damaged.out, Contains("damaged: shards/000001.h5"));
  CHECK(damaged.messages.empty());
  const Outcome wrong = run_program("run -q " + sweep + " --shards 9:9");
  CHECK(wrong.code == 2);
  CHECK(split_lines(wrong.messages).size() == 1);
}

TEST_CASE("A command that a signal ended is suggested again", "[io]") {
  const TemporaryFolder folder;
  // One hour of driving takes about a minute to simulate.
  const std::string file = folder / "a run.csv";
  const Outcome outcome =
      run_shell("timeout --preserve-status -s INT 0.5 " STRUT_PROGRAM " simulate " + kSedan + " " +
                kBump + " --rate 1 --set duration=3600 -o " + quote_word(file));
  CHECK(outcome.code == 130);
  CHECK_THAT(outcome.messages, Contains("strut: interrupted\n"));
  const std::vector<std::string> words = check_hint(outcome.messages);
  CHECK(words[1] == "simulate");
  CHECK(words.back() == file);
}

TEST_CASE("Progress includes the time to go once that is known", "[unit]") {
  CHECK(format_progress(0, 5000, "cases", 3.0) == "0/5,000 cases");
  CHECK(format_progress(1250, 5000, "cases", 100.0) == "1,250/5,000 cases, 5 min 0 s to go");
  CHECK(format_progress(5000, 5000, "cases", 100.0) == "5,000/5,000 cases");
}

TEST_CASE("Words are quoted for a shell only if necessary", "[unit]") {
  CHECK(quote_if_needed("sweeps/paper-2.toml") == "sweeps/paper-2.toml");
  CHECK(quote_if_needed("mass=1.5") == "mass=1.5");
  CHECK(quote_if_needed("a sweep") == "'a sweep'");
  CHECK(quote_if_needed("") == "''");
  CHECK(quote_if_needed("it's") == "'it'\\''s'");
  for (const std::string word : {"~", "$HOME", "a;b", "*", "a b", "#x", "[1]", "\\"}) {
    CHECK(split_as_bash(quote_if_needed(word)) == std::vector<std::string>{word});
  }
}

}  // namespace
}  // namespace strut
