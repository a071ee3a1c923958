// Can a file system keep what a sweep folder promises?
#pragma once

#include <cstdint>
#include <filesystem>

#include "base/error/finding.h"

namespace strut {

/// What a sweep still needs.
struct SpaceNeeds {
  double bytes = 0.0;
  std::int64_t files = 0;
};

/// Tries everything in a subfolder of its own, which it removes again. Throws EnvironmentError
/// where nothing can be written at all.
Findings check_file_system(const std::filesystem::path& folder, const SpaceNeeds& needs);

}  // namespace strut
