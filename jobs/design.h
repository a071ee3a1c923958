// `strut design`: finds the instant, window and sensors that identify a sweep's parameters best.
#pragma once

#include "jobs/cli/arguments.h"

namespace strut {

Arguments describe_design();
int run_design(const Arguments& arguments);

}  // namespace strut
