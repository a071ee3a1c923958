// A maneuver from its TOML file.
#pragma once

#include <filesystem>

#include "model/scenario/maneuver.h"

namespace strut {

/// Reads `maneuvers/*.toml`: speed, duration, drive torque, trim, gravity; the table [bump] with
/// shape, side, distance, height, length, ramp, count, spacing, or the CSV file of a tabulated
/// profile (columns `position` and `height`, m; the position runs forward from the bump's center);
/// the table [road] with the class of a random road (class or roughness, seed, length, begin,
/// track_width), or the CSV file of a surveyed one (columns `position`, m ahead of the front wheel
/// centers at the start, and `left` and `right`, or `height`; fade). Throws InputError with file,
/// line, key, value and allowed values.
ManeuverSpec read_maneuver(const std::filesystem::path& path);

}  // namespace strut
