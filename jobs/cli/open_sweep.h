// The sweep folder, kernel and number of threads that the arguments of a command name.
#pragma once

#include "jobs/cli/arguments.h"
#include "sweep/folder.h"

namespace strut {

struct OpenSweep {
  SweepFolder folder;
  Plan plan;
};

/// Opens the planned folder that is the only positional argument. Throws InputError.
OpenSweep open_sweep(const Arguments& arguments);

/// The value of `--isa NAME`: an instruction set of this machine.
ArgumentValue isa_value();

/// The kernel of `--isa NAME`; by default the one with the widest lanes.
const Kernel& find_kernel(const Arguments& arguments);

/// `--threads N`; by default one thread for each processor available to this process.
int find_threads(const Arguments& arguments);

}  // namespace strut
