// `strut run` and `strut resume`.
#pragma once

#include "jobs/cli/arguments.h"

namespace strut {

Arguments describe_run();
int run_run(const Arguments& arguments);
Arguments describe_resume();
int run_resume(const Arguments& arguments);

}  // namespace strut
