// Bounds and fits as tables: a line for each case.
#pragma once

#include "jobs/study/noise_limits.h"

namespace strut {

void write_bounds(const std::filesystem::path& file, const std::vector<std::string>& parameters,
                  const std::vector<BoundedCase>& cases);
void write_fits(const std::filesystem::path& file, const std::vector<std::string>& parameters,
                const std::vector<FittedCase>& fits);

}  // namespace strut
