#include "jobs/completion.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <iostream>

#include "base/text/nearest_name.h"
#include "jobs/cli/messages.h"
#include "jobs/completion/scripts.h"

namespace strut {
namespace {

struct Shell {
  const char* name;
  std::string (*make_script)(const CommandTable& commands);
  const char* load;  // the command line that loads the script
};

constexpr std::array<Shell, 3> kShells = {
    {{"bash", &make_bash_completion, "source <(strut completion bash)"},
     {"zsh", &make_zsh_completion, "source <(strut completion zsh)"},
     {"fish", &make_fish_completion, "strut completion fish | source"}}};

std::vector<std::string> list_shells() {
  std::vector<std::string> names;
  names.reserve(kShells.size());
  for (const Shell& shell : kShells) names.emplace_back(shell.name);
  return names;
}

const Shell& find_shell(const Arguments& arguments) {
  const std::vector<std::string> names = list_shells();
  const std::string& word = arguments.only_operand(", one of " + join_names(names));
  for (const Shell& shell : kShells) {
    if (word == shell.name) return shell;
  }
  throw arguments.usage_error(fmt::format("unknown shell '{}'; must be one of {}{}", word,
                                          join_names(names), suggest_name(word, names)));
}

}  // namespace

Arguments describe_completion() {
  Arguments arguments(
      "strut completion SHELL",
      "Prints a script with which a shell completes commands, options and their values. An\n"
      "installed strut includes the scripts; for one that is not installed, a line in ~/.bashrc,\n"
      "~/.zshrc (after compinit) or ~/.config/fish/config.fish loads the script.",
      "  source <(strut completion bash)\n"
      "  source <(strut completion zsh)\n"
      "  strut completion fish | source");
  arguments.add_operand(ArgumentValue::one_of("SHELL", list_shells()));
  return arguments;
}

int run_completion(const Arguments& arguments, const CommandTable& commands) {
  const Shell& shell = find_shell(arguments);
  std::cout << shell.make_script(commands);
  // No suggestion where a shell reads the script while it starts.
  if (isatty(STDOUT_FILENO) == 1) suggest_next_line(shell.load);
  return kExitDone;
}

}  // namespace strut
