#include "jobs/completion.h"

#include <unistd.h>

#include <iostream>

#include "base/text/build_info.h"
#include "base/text/quote_word.h"
#include "jobs/cli/messages.h"
#include "jobs/commands.h"
#include "model_files/parameters.h"

namespace strut {
namespace {

/// What does not depend on the tables. Bash breaks words at = and :, so they are joined again
/// first; what is replaced is the last piece only.
constexpr const char* kFunctions = R"bash(
# The words of an answer that begin with the current one.
_strut_words() {
  mapfile -t COMPREPLY < <(compgen -W "$*" -- "$current")
}

_strut_settings() {
  compopt -o nospace 2>/dev/null
  mapfile -t COMPREPLY < <(compgen -S = -W "$_strut_parameters" -- "$current")
}

_strut_folders() {
  compopt -o filenames 2>/dev/null
  mapfile -t COMPREPLY < <(compgen -d -- "$current")
}

# Folders, and files with one of these endings, or all without any.
_strut_files() {
  compopt -o filenames 2>/dev/null
  if (($# == 0)); then
    mapfile -t COMPREPLY < <(compgen -f -- "$current")
    return
  fi
  local ending
  mapfile -t COMPREPLY < <(
    compgen -d -- "$current"
    for ending in "$@"; do compgen -f -X "!*.$ending" -- "$current"; done)
}

_strut() {
  local words=() word i glue=0 before=""
  COMPREPLY=()
  for ((i = 0; i <= COMP_CWORD; ++i)); do
    word=${COMP_WORDS[i]}
    if [[ $i -gt 1 && ( $glue == 1 || $word == [=:] ) ]]; then
      words[${#words[@]}-1]+=$word
    else
      words+=("$word")
    fi
    glue=0
    [[ $word == [=:] ]] && glue=1
  done
  local last=$((${#words[@]} - 1)) current=${COMP_WORDS[COMP_CWORD]} command=${words[1]-}
  [[ $current == [=:] ]] && current=""
  if ((last <= 1)); then
    _strut_words "$_strut_commands --help --version"
    return
  fi
  if [[ $command == help ]]; then
    ((last == 2)) && _strut_words "$_strut_commands"
    return
  fi
  # Operands before the current word, and the option whose value it is.
  local operand=1 option=""
  for ((i = 2; i < last; ++i)); do
    word=${words[i]}
    if [[ -n $option ]]; then
      option=""
    elif [[ $word == --*=* ]]; then
      :
    elif [[ $word == -* ]]; then
      _strut_takes_value "$command" "$word" && option=$word
    else
      ((++operand))
    fi
  done
  word=${words[last]}
  if [[ -z $option && $word == --*=* ]]; then
    option=${word%%=*}
  fi
  if [[ -n $option ]]; then
    _strut_value "$command" "$option"
  elif [[ $word == -* ]]; then
    _strut_words "$(_strut_options "$command")"
  else
    _strut_operand "$command" "$operand"
  fi
}

complete -F _strut strut
)bash";

std::string join(const std::vector<std::string>& words, const std::string& between = " ") {
  std::string joined;
  for (const std::string& word : words) joined += (joined.empty() ? "" : between) + word;
  return joined;
}

/// "--output", "-o"
std::vector<std::string> list_spellings(const ArgumentOption& option) {
  std::vector<std::string> spellings = {"--" + option.name};
  if (!option.letter.empty()) spellings.push_back("-" + option.letter);
  return spellings;
}

/// What completes a value; nothing where that is unknown.
std::string make_action(const ArgumentValue& value) {
  std::string endings;
  for (const std::string& ending : value.endings) endings += " " + quote_if_needed(ending);
  switch (value.kind) {
    case ArgumentValue::Kind::kText:
      return "";
    case ArgumentValue::Kind::kChoice:
      return "_strut_words " + quote_word(join(value.words));
    case ArgumentValue::Kind::kSetting:
      return "_strut_settings";
    case ArgumentValue::Kind::kFolder:
      return "_strut_folders";
    case ArgumentValue::Kind::kFile:
    case ArgumentValue::Kind::kPath:
      return "_strut_files" + endings;
  }
  return "";
}

std::string make_case(const std::string& pattern, const std::string& action) {
  return "    " + pattern + ") " + action + " ;;\n";
}

/// Patterns "command:what".
std::string make_function(const std::string& name, const std::string& cases) {
  return name + "() {\n  case $1:$2 in\n" + cases + "    *) return 1 ;;\n  esac\n}\n\n";
}

std::string make_option_lists() {
  std::string cases;
  for (const Command& command : list_commands()) {
    const Arguments arguments = command.describe();
    std::vector<std::string> words;
    for (const auto* options : {&arguments.options(), &Arguments::common_options()}) {
      for (const ArgumentOption& option : *options) {
        for (std::string& spelling : list_spellings(option)) words.push_back(std::move(spelling));
      }
    }
    cases += make_case(command.name, "echo " + quote_word(join(words)));
  }
  return "_strut_options() {\n  case $1 in\n" + cases + "  esac\n}\n\n";
}

std::string make_values() {
  std::string with_value, actions;
  for (const Command& command : list_commands()) {
    const Arguments arguments = command.describe();
    for (const ArgumentOption& option : arguments.options()) {
      if (option.is_switch) continue;
      std::vector<std::string> patterns;
      for (const std::string& spelling : list_spellings(option)) {
        patterns.push_back(command.name + (":" + spelling));
      }
      with_value += make_case(join(patterns, "|"), "return 0");
      const std::string action = make_action(option.value);
      if (!action.empty()) actions += make_case(join(patterns, "|"), action);
    }
  }
  return make_function("_strut_takes_value", with_value) + make_function("_strut_value", actions);
}

std::string make_operands() {
  std::string cases;
  for (const Command& command : list_commands()) {
    const Arguments arguments = command.describe();
    const auto& operands = arguments.operands();
    for (std::size_t i = 0; i < operands.size(); ++i) {
      const bool repeats = arguments.last_operand_repeats() && i + 1 == operands.size();
      const std::string action = make_action(operands[i]);
      const std::string place = repeats ? "*" : std::to_string(i + 1);
      if (!action.empty()) cases += make_case(command.name + (":" + place), action);
    }
  }
  return make_function("_strut_operand", cases);
}

}  // namespace

Arguments describe_completion() {
  Arguments arguments(
      "strut completion bash",
      "Prints a script that makes bash complete the commands, their options and the values these\n"
      "take. An installed strut brings it along; for one that is not installed a line in\n"
      "~/.bashrc loads it.",
      "  source <(strut completion bash)");
  arguments.add_operand(ArgumentValue::one_of({"bash"}));
  return arguments;
}

int run_completion(const Arguments& arguments) {
  const std::vector<std::string>& shells = arguments.operands().front().words;
  if (arguments.positional() != shells) {
    throw arguments.usage_error("expected the name of a shell: " + join(shells));
  }
  std::cout << make_bash_completion();
  // A script that a shell reads as it starts is no place for a hint.
  if (isatty(STDOUT_FILENO) == 1) suggest_next_line("source <(strut completion bash)");
  return kExitDone;
}

std::string make_bash_completion() {
  std::vector<std::string> names;
  for (const Command& command : list_commands()) names.emplace_back(command.name);
  names.emplace_back("help");
  std::vector<std::string> parameters;
  for (const ParameterInfo& parameter : list_parameters()) parameters.push_back(parameter.name);
  return "# Completion of strut " + std::string(get_build_info().version) +
         " for bash, made by `strut completion bash`.\n\n_strut_commands=" +
         quote_word(join(names)) + "\n_strut_parameters=" + quote_word(join(parameters)) + "\n\n" +
         make_option_lists() + make_values() + make_operands() + (kFunctions + 1);
}

}  // namespace strut
