// Makes the commands that the tasks of a submission run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "cluster/dispatcher.h"
#include "cluster/submission.h"
#include "io/store/sweep_folder.h"

namespace strut {

/// The file that the last task of a submission merges, in the sweep's folder.
constexpr const char* kMerged = "merged.h5";

struct ScriptOptions {
  Resources resources;
  std::int64_t at_once = 0;  // max. number of tasks of an array that run at once; 0: no limit
  /// Node-local folder for a copy of the program on each node, as a text in double quotes of bash;
  /// see check_scratch(). "": none.
  std::string scratch;
  /// Lines of bash before the program, which may set an array `launcher`, the words before it:
  /// module load gcc; launcher=(apptainer exec strut.sif).
  std::string prologue = {};
};

/// Throws InputError if a scratch folder is not absolute, or if bash would expand more in it than
/// $NAME and ${NAME}.
void check_scratch(const std::string& scratch);

/// Returns the tasks of all parts in the order of Submission::list_parts(). `folder` must be
/// absolute.
std::vector<TaskArray> list_task_arrays(const SweepFolder& folder, const Submission& submission,
                                        const ScriptOptions& options);

}  // namespace strut
