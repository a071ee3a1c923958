#include <fmt/format.h>

#include "base/text/build_info.h"
#include "base/text/fill_template.h"
#include "embedded/texts.h"
#include "jobs/completion/scripts.h"
#include "jobs/completion/words.h"

namespace strut {
namespace {

using Lines = std::vector<std::string>;

/// One word of fish.
std::string quote(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) {
    if (c == '\'' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + "'";
}

/// The candidates for a value as an argument of `complete -a`; empty: there are none.
std::string make_candidates(const ArgumentValue& value) {
  switch (value.kind) {
    case ArgumentValue::Kind::kText:
      return "";
    case ArgumentValue::Kind::kChoice:
      return fmt::format("{}", fmt::join(value.words, " "));
    case ArgumentValue::Kind::kSetting:
      return "$__strut_parameters=";
    case ArgumentValue::Kind::kFolder:
      return "(__strut_folders)";
    case ArgumentValue::Kind::kFile:
    case ArgumentValue::Kind::kPath:
      break;
  }
  return fmt::format("(__strut_files {})", fmt::join(value.endings, " "));
}

/// One line "complete -c strut -n CONDITION ...".
std::string make_line(const std::string& condition, const std::string& rest) {
  return fmt::format("complete -c strut -n {} {}", quote(condition), rest);
}

std::string make_option(const Command& command, const ArgumentOption& option) {
  std::string rest = "-l " + option.name;
  if (!option.letter.empty()) rest += " -s " + option.letter;
  if (!option.is_switch) {
    const std::string candidates = make_candidates(option.value);
    rest += candidates.empty() ? " -x" : " -x -a " + quote(candidates);
  }
  return make_line(fmt::format("__strut_in {}", command.name), rest + " -d " + quote(option.help));
}

void add_operands(const Command& command, Lines& lines) {
  const Arguments arguments = command.describe();
  const auto& operands = arguments.operands();
  for (std::size_t i = 0; i < operands.size(); ++i) {
    const bool repeats = arguments.last_operand_repeats() && i + 1 == operands.size();
    const std::string candidates = make_candidates(operands[i]);
    if (candidates.empty()) continue;
    lines.push_back(make_line(
        fmt::format("__strut_at {} {}{}", command.name, i + 1, repeats ? " and-later" : ""),
        "-a " + quote(candidates)));
  }
}

Lines list_patterns(const Command& command) {
  Lines patterns;
  const Arguments arguments = command.describe();
  for (const ArgumentOption& option : arguments.options()) {
    if (option.is_switch) continue;
    for (const std::string& spelling : list_spellings(option)) {
      patterns.push_back(fmt::format("{}:{}", command.name, spelling));
    }
  }
  return patterns;
}

}  // namespace

std::string make_fish_completion(const CommandTable& commands) {
  Lines takes_value, lines;
  for (const Command& command : commands) {
    const Lines patterns = list_patterns(command);
    if (!patterns.empty()) {
      takes_value.push_back(fmt::format("    case {}\n      return 0", fmt::join(patterns, " ")));
    }
    lines.push_back(make_line("__strut_before_command; or __strut_at help 1",
                              fmt::format("-a {} -d {}", command.name, quote(command.purpose))));
    for (const ArgumentOption& option : list_all_options(command.describe())) {
      lines.push_back(make_option(command, option));
    }
    add_operands(command, lines);
  }
  return fill_template(embedded::strut_fish_in,
                       {{"version", get_build_info().version},
                        {"parameters", join_parameter_names()},
                        {"takes_value", fmt::format("{}", fmt::join(takes_value, "\n"))},
                        {"commands", fmt::format("{}", fmt::join(lines, "\n"))}});
}

}  // namespace strut
