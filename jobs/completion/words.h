// Words that the completion scripts of all shells have in common.
#pragma once

#include <string>
#include <vector>

#include "jobs/cli/arguments.h"

namespace strut {

/// All spellings of an option: "--output", "-o".
std::vector<std::string> list_spellings(const ArgumentOption& option);

/// The options of one command, then those of every command.
std::vector<ArgumentOption> list_all_options(const Arguments& arguments);

/// The names that --set takes, separated by blanks.
std::string join_parameter_names();

}  // namespace strut
