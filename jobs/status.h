// `strut status`.
#pragma once

#include "jobs/cli/arguments.h"

namespace strut {

Arguments describe_status();
int run_status(const Arguments& arguments);

}  // namespace strut
