// strut plan: from a sweep file to a sweep folder.
#pragma once

#include "jobs/cli/arguments.h"

namespace strut {

Arguments describe_plan();
int run_plan(const Arguments& arguments);

}  // namespace strut
