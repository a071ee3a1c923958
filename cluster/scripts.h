// What the tasks of a submission run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "cluster/dispatcher.h"
#include "cluster/submission.h"
#include "io/store/sweep_folder.h"

namespace strut {

/// What the collector writes in the sweep's folder.
constexpr const char* kMerged = "merged.h5";

struct ScriptOptions {
  Resources resources;
  std::int64_t at_once = 0;  // tasks of an array; 0: as many as there is room for
  /// Node-local folder in which each node keeps a copy of the program, as in double quotes of bash:
  /// check_scratch(). "": none.
  std::string scratch;
};

/// Refuses a scratch folder that is not absolute, or of which bash would expand more than $NAME and
/// ${NAME}. Throws InputError.
void check_scratch(const std::string& scratch);

/// The tasks of all parts, in the order of Submission::list_parts(). `folder` is absolute.
std::vector<TaskArray> list_task_arrays(const SweepFolder& folder, const Submission& submission,
                                        const ScriptOptions& options);

}  // namespace strut
