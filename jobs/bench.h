// `strut bench`: throughput and accuracy of this machine.
#pragma once

#include "jobs/cli/arguments.h"

namespace strut {

Arguments describe_bench();
int run_bench(const Arguments& arguments);

}  // namespace strut
