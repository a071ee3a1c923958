// Options of `strut run` and `strut resume`.
#pragma once

#include <optional>

#include "cluster/task_run.h"
#include "jobs/cli/open_sweep.h"
#include "sweep/run.h"

namespace strut {

/// Throws InputError. `retries`: as `strut resume` does.
RunOptions read_run_options(const Arguments& arguments, const Plan& plan, bool retries);

/// The task of --task; its shards become those of `options`. Throws InputError.
std::optional<TaskRun> find_task(const Arguments& arguments, const OpenSweep& sweep,
                                 RunOptions& options);

}  // namespace strut
