// strut list: what can be set, recorded, switched on and called.
#pragma once

#include "jobs/cli/arguments.h"

namespace strut {

Arguments describe_list();
int run_list(const Arguments& arguments);

}  // namespace strut
