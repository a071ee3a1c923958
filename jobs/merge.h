// strut merge: one file of all shards.
#pragma once

#include "jobs/cli/arguments.h"

namespace strut {

Arguments describe_merge();
int run_merge(const Arguments& arguments);

}  // namespace strut
