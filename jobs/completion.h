// strut completion: what makes a shell complete commands, options and values.
#pragma once

#include <string>

#include "jobs/cli/arguments.h"

namespace strut {

Arguments describe_completion();
int run_completion(const Arguments& arguments);

/// For bash, of every command's table.
std::string make_bash_completion();

}  // namespace strut
