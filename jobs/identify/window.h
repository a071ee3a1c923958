// `strut identify` by a network over windows of time histories.
#pragma once

#include <filesystem>
#include <vector>

#include "jobs/cli/arguments.h"
#include "train/model/model_file.h"

namespace strut {

/// Identifies the parameters from each of `files`, prints and writes. Returns an exit code. Throws
/// InputError.
int identify_by_window(const Arguments& arguments, const TrainedModel& model,
                       const std::vector<std::filesystem::path>& files);

}  // namespace strut
