// strut identify: parameters from measured data.
#pragma once

#include "jobs/cli/arguments.h"

namespace strut {

Arguments describe_identify();
int run_identify(const Arguments& arguments);

}  // namespace strut
