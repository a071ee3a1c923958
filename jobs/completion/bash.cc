#include <fmt/format.h>

#include "base/text/build_info.h"
#include "base/text/fill_template.h"
#include "base/text/quote_word.h"
#include "embedded/texts.h"
#include "jobs/completion/scripts.h"
#include "jobs/completion/words.h"

namespace strut {
namespace {

using Lines = std::vector<std::string>;

/// The function call that completes a value; empty: nothing does.
std::string make_action(const ArgumentValue& value) {
  switch (value.kind) {
    case ArgumentValue::Kind::kText:
      return "";
    case ArgumentValue::Kind::kChoice:
      return "_strut_words " + quote_word(fmt::format("{}", fmt::join(value.words, " ")));
    case ArgumentValue::Kind::kSetting:
      return "_strut_settings";
    case ArgumentValue::Kind::kFolder:
      return "_strut_folders";
    case ArgumentValue::Kind::kFile:
    case ArgumentValue::Kind::kPath:
      break;
  }
  std::string action = "_strut_files";
  for (const std::string& ending : value.endings) action += " " + quote_if_needed(ending);
  return action;
}

/// A line of a case statement; none for an empty action.
void add_case(const std::string& pattern, const std::string& action, Lines& lines) {
  if (!action.empty()) lines.push_back(fmt::format("    {}) {} ;;", pattern, action));
}

/// "simulate:--output|simulate:-o"
std::string make_pattern(const Command& command, const ArgumentOption& option) {
  Lines patterns;
  for (const std::string& spelling : list_spellings(option)) {
    patterns.push_back(fmt::format("{}:{}", command.name, spelling));
  }
  return fmt::format("{}", fmt::join(patterns, "|"));
}

void add_options(const Command& command, Lines& lines) {
  Lines words;
  for (const ArgumentOption& option : list_all_options(command.describe())) {
    for (std::string& spelling : list_spellings(option)) words.push_back(std::move(spelling));
  }
  add_case(command.name, "echo " + quote_word(fmt::format("{}", fmt::join(words, " "))), lines);
}

void add_values(const Command& command, Lines& takes_value, Lines& values) {
  const Arguments arguments = command.describe();
  for (const ArgumentOption& option : arguments.options()) {
    if (option.is_switch) continue;
    const std::string pattern = make_pattern(command, option);
    add_case(pattern, "return 0", takes_value);
    add_case(pattern, make_action(option.value), values);
  }
}

void add_operands(const Command& command, Lines& lines) {
  const Arguments arguments = command.describe();
  const auto& operands = arguments.operands();
  for (std::size_t i = 0; i < operands.size(); ++i) {
    const bool repeats = arguments.last_operand_repeats() && i + 1 == operands.size();
    const std::string number = repeats ? "*" : std::to_string(i + 1);
    add_case(fmt::format("{}:{}", command.name, number), make_action(operands[i]), lines);
  }
}

std::string join_lines(const Lines& lines) { return fmt::format("{}", fmt::join(lines, "\n")); }

}  // namespace

std::string make_bash_completion(const CommandTable& commands) {
  Lines names, options, takes_value, values, operands;
  for (const Command& command : commands) {
    names.emplace_back(command.name);
    add_options(command, options);
    add_values(command, takes_value, values);
    add_operands(command, operands);
  }
  return fill_template(embedded::strut_bash_in,
                       {{"version", get_build_info().version},
                        {"commands", quote_word(fmt::format("{} help", fmt::join(names, " ")))},
                        {"parameters", quote_word(join_parameter_names())},
                        {"options", join_lines(options)},
                        {"takes_value", join_lines(takes_value)},
                        {"values", join_lines(values)},
                        {"operands", join_lines(operands)}});
}

}  // namespace strut
