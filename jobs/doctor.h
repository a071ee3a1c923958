// strut doctor: can a file system, a scheduler and its processors keep what a sweep promises?
#pragma once

#include "jobs/cli/arguments.h"

namespace strut {

Arguments describe_doctor();
int run_doctor(const Arguments& arguments);

}  // namespace strut
