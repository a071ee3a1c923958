// `strut identify` by a network from snapshots: its options and its run.
#pragma once

#include <filesystem>
#include <vector>

#include "jobs/cli/arguments.h"
#include "train/model/model_file.h"

namespace strut {

/// --set, --event-time, --noise, --extrapolate
void add_snapshot_options(Arguments& arguments);

/// Reads the files (or --set), identifies, prints and writes. Returns an exit code. Throws
/// InputError.
int identify_by_snapshot(const Arguments& arguments, const TrainedModel& model,
                         const std::vector<std::filesystem::path>& files);

}  // namespace strut
