// strut init: commented files to begin with.
#pragma once

#include "jobs/cli/arguments.h"

namespace strut {

Arguments describe_init();
int run_init(const Arguments& arguments);

}  // namespace strut
