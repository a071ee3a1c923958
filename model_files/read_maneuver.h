// A maneuver from its TOML file.
#pragma once

#include <filesystem>

#include "model/scenario/maneuver.h"

namespace strut {

/// Reads `maneuvers/*.toml`: speed, duration, drive torque, trim, gravity, and the table [bump]
/// with shape, side, distance, height, length, ramp, or the CSV file of a tabulated profile
/// (columns `position` and `height`, m; the position runs forward from the bump's center). Throws
/// InputError with file, line, key, value and allowed values.
ManeuverSpec read_maneuver(const std::filesystem::path& path);

}  // namespace strut
