#include <fmt/format.h>

#include "base/text/build_info.h"
#include "base/text/fill_template.h"
#include "base/text/quote_word.h"
#include "embedded/texts.h"
#include "jobs/completion/scripts.h"
#include "jobs/completion/words.h"

namespace strut {
namespace {

/// `text` with a backslash before each of `characters`.
std::string escape(const std::string& text, std::string_view characters) {
  std::string escaped;
  for (const char c : text) {
    if (characters.find(c) != std::string_view::npos) escaped += '\\';
    escaped += c;
  }
  return escaped;
}

/// The part of a specification for _arguments that completes a value: ":FILE: _strut_files csv".
/// Behind a space, zsh calls a function with these words alone; else it adds options of its own.
std::string make_action(const ArgumentValue& value) {
  const std::string message = escape(value.name, ":\\");
  switch (value.kind) {
    case ArgumentValue::Kind::kText:
      return fmt::format(":{}: ", message);
    case ArgumentValue::Kind::kChoice:
      return fmt::format(":{}:({})", message, fmt::join(value.words, " "));
    case ArgumentValue::Kind::kSetting:
      return fmt::format(":{}: _strut_settings", message);
    case ArgumentValue::Kind::kFolder:
      return fmt::format(":{}:_files -/", message);
    case ArgumentValue::Kind::kFile:
    case ArgumentValue::Kind::kPath:
      break;
  }
  return fmt::format(":{}: _strut_files {}", message, fmt::join(value.endings, " "));
}

/// Specifications for _arguments, one for each spelling; a spelling excludes the others, unless the
/// option may be repeated.
void add_option(const ArgumentOption& option, std::vector<std::string>& specifications) {
  const std::vector<std::string> spellings = list_spellings(option);
  const std::string others = option.repeats ? "*" : fmt::format("({})", fmt::join(spellings, " "));
  for (const std::string& spelling : spellings) {
    const bool is_long = spelling.starts_with("--");
    specifications.push_back(fmt::format("{}{}{}[{}]{}", others, spelling,
                                         option.is_switch ? ""
                                         : is_long        ? "="
                                                          : "+",
                                         escape(option.help, ":[]\\"),
                                         option.is_switch ? "" : make_action(option.value)));
  }
}

/// "    simulate) _arguments SPECIFICATION ... ;;"
std::string make_case(const Command& command) {
  const Arguments arguments = command.describe();
  std::vector<std::string> specifications;
  for (const ArgumentOption& option : list_all_options(arguments)) {
    add_option(option, specifications);
  }
  const auto& operands = arguments.operands();
  for (std::size_t i = 0; i < operands.size(); ++i) {
    const bool repeats = arguments.last_operand_repeats() && i + 1 == operands.size();
    specifications.push_back((repeats ? "*" : std::to_string(i + 1)) + make_action(operands[i]));
  }
  std::string text = fmt::format("    {}) _arguments", command.name);
  for (const std::string& s : specifications) text += " \\\n      " + quote_word(s);
  return text + " ;;";
}

}  // namespace

std::string make_zsh_completion(const CommandTable& commands) {
  std::vector<std::string> descriptions, cases;
  for (const Command& command : commands) {
    descriptions.push_back(
        "    " + quote_word(fmt::format("{}:{}", command.name, escape(command.purpose, ":\\"))));
    cases.push_back(make_case(command));
  }
  return fill_template(embedded::strut_zsh_in,
                       {{"version", get_build_info().version},
                        {"parameters", join_parameter_names()},
                        {"commands", fmt::format("{}", fmt::join(descriptions, "\n"))},
                        {"arguments", fmt::format("{}", fmt::join(cases, "\n"))}});
}

}  // namespace strut
