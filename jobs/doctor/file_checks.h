// Tests whether a file system has the properties that a sweep folder relies on.
#pragma once

#include <cstdint>
#include <filesystem>

#include "base/error/finding.h"

namespace strut {

/// Space for the missing shards of a sweep.
struct SpaceNeeds {
  double bytes = 0.0;
  std::int64_t files = 0;
};

/// Runs all tests in a temporary subfolder. Throws EnvironmentError if nothing can be written.
Findings check_file_system(const std::filesystem::path& folder, const SpaceNeeds& needs);

}  // namespace strut
