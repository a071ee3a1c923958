// `strut simulate`: one run, all channels over time; or the suspension's kinematics.
#pragma once

#include "jobs/cli/arguments.h"

namespace strut {

Arguments describe_simulate();
int run_simulate(const Arguments& arguments);

}  // namespace strut
