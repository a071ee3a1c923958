// strut completion: a script that makes a shell complete commands, options and values.
#pragma once

#include "jobs/cli/command.h"

namespace strut {

Arguments describe_completion();
int run_completion(const Arguments& arguments, const CommandTable& commands);

}  // namespace strut
