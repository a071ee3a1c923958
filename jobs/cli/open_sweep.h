// The sweep folder that a command names.
#pragma once

#include "jobs/cli/arguments.h"
#include "sweep/folder.h"

namespace strut {

struct OpenSweep {
  SweepFolder folder;
  Plan plan;
};

/// The one positional argument as a planned folder. Throws InputError.
OpenSweep open_sweep(const Arguments& arguments);

/// The instruction sets that this machine has, for `--isa NAME`.
ArgumentValue isa_value();

/// The kernel of `--isa NAME`, the widest without.
const Kernel& find_kernel(const Arguments& arguments);

/// `--threads N`, without it one for each processor this process may use.
int find_threads(const Arguments& arguments);

}  // namespace strut
