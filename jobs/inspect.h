// strut inspect: what a measured file holds, and a campaign to begin with.
#pragma once

#include "jobs/cli/arguments.h"

namespace strut {

Arguments describe_inspect();
int run_inspect(const Arguments& arguments);

}  // namespace strut
