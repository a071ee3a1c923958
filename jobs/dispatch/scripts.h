// What the tasks of a submission run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "io/sweep_folder.h"
#include "jobs/dispatch/dispatcher.h"
#include "jobs/dispatch/submission.h"

namespace strut {

struct ScriptOptions {
  Resources resources;
  std::int64_t at_once = 0;  // tasks of an array; 0: as many as there is room for
  /// Node-local folder, as bash expands it, where each node keeps a copy of the program; "": none.
  std::string scratch;
};

/// The scripts of all parts, in the order of Submission::list_parts(). `folder` is absolute.
std::vector<std::string> make_scripts(const Dispatcher& dispatcher, const SweepFolder& folder,
                                      const Submission& submission, const ScriptOptions& options);

}  // namespace strut
