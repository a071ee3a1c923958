// strut submit: a sweep as tasks that run elsewhere.
#pragma once

#include "jobs/cli/arguments.h"

namespace strut {

Arguments describe_submit();
int run_submit(const Arguments& arguments);

}  // namespace strut
