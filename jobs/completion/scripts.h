// Completion scripts for shells, generated from the commands' tables of arguments: names of
// commands and options, words of choices, names of --set, files by ending.
#pragma once

#include <string>

#include "jobs/cli/command.h"

namespace strut {

std::string make_bash_completion(const CommandTable& commands);
std::string make_zsh_completion(const CommandTable& commands);
std::string make_fish_completion(const CommandTable& commands);

}  // namespace strut
