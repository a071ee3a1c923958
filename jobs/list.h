// strut list: parameters, channels and effects of a model; commands.
#pragma once

#include "jobs/cli/command.h"

namespace strut {

Arguments describe_list();
int run_list(const Arguments& arguments, const CommandTable& commands);

}  // namespace strut
