// `strut identify` of a corner on the wheel plate of an inspection stand.
#pragma once

#include <filesystem>
#include <vector>

#include "jobs/cli/arguments.h"

namespace strut {

/// Whether the call is a bench test: a quarter car without a maneuver, which its record replaces.
bool is_plate_test(const Arguments& arguments, const std::filesystem::path& model);

/// Reads the record with the columns time, road_position and tire_force, fits the rig, prints its
/// parameters and the figures of the stand (identify/plate.h). Returns an exit code. Throws
/// InputError.
int identify_by_plate(const Arguments& arguments, const std::filesystem::path& rig,
                      const std::vector<std::filesystem::path>& files);

}  // namespace strut
