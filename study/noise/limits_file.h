// Bounds and fits as CSV files, one row per case.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "study/noise/limits.h"

namespace strut {

/// Names of the files in `folder`.
std::filesystem::path find_bounds_file(const std::filesystem::path& folder,
                                       const NoiseSnapshots& snapshots);
std::filesystem::path find_fits_file(const std::filesystem::path& folder, double scale);

/// `parameters`: names of the identified parameters, in the order of BoundedCase::parameters.
/// Throws EnvironmentError.
void write_bounds(const std::filesystem::path& file, const std::vector<std::string>& parameters,
                  const std::vector<BoundedCase>& cases);
void write_fits(const std::filesystem::path& file, const std::vector<std::string>& parameters,
                const std::vector<FittedCase>& fits);

/// Bounds of snapshots at scale 1; bounds at other scales are proportional. Throws InputError where
/// the file is missing or damaged.
std::vector<BoundedCase> read_bounds(const std::filesystem::path& file,
                                     const std::vector<std::string>& parameters);
std::vector<FittedCase> read_fits(const std::filesystem::path& file,
                                  const std::vector<std::string>& parameters);

}  // namespace strut
