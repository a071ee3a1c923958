// `strut diagnose`: what the simulation gets wrong, why, and what mending it gains.
#pragma once

#include "jobs/cli/arguments.h"

namespace strut {

Arguments describe_diagnose();
int run_diagnose(const Arguments& arguments);

}  // namespace strut
