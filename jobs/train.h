// strut train: a network that identifies parameters from a snapshot.
#pragma once

#include "jobs/cli/arguments.h"

namespace strut {

Arguments describe_train();
int run_train(const Arguments& arguments);

}  // namespace strut
