// strut identify: parameters from measurements.
#pragma once

#include "jobs/arguments.h"

namespace strut {

Arguments describe_identify();
int run_identify(const Arguments& arguments);

}  // namespace strut
