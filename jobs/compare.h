// `strut compare`: compares measured with simulated runs, channel by channel.
#pragma once

#include "jobs/cli/arguments.h"

namespace strut {

Arguments describe_compare();
int run_compare(const Arguments& arguments);

}  // namespace strut
