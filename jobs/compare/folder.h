// The folder of a comparison.
#pragma once

#include <filesystem>

#include "jobs/arguments.h"
#include "jobs/report/page_file.h"

namespace strut {

struct CompareFolder : PageFolder {
  std::filesystem::path json() const { return root / "compare.json"; }
};

/// The folder of --output, made where it is missing. Throws InputError where it is missing, a file,
/// or holds a comparison and --force is not given; EnvironmentError where it cannot be made.
CompareFolder find_compare_folder(const Arguments& arguments);

}  // namespace strut
