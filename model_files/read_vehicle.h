// A full vehicle from its TOML file.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "model/car/spec.h"

namespace strut {

/// Reads a vehicle file of type "full_vehicle" (`examples/vehicles/paper_sedan.toml` shows every
/// key) with its effects (read_effects.h), its force maps (read_force_maps.h) and the tire file it
/// names. Throws InputError with file, line, key, value and allowed values for unknown or missing
/// keys, wrong types, values out of range, impossible inertias, and coinciding hardpoints. The
/// model checks whether the loops close and the springs carry the car (assemble_vehicle).
VehicleSpec read_vehicle(const std::filesystem::path& path);

/// Values of the key `preload` of `[spring]`, in the order of PreloadKind.
const std::vector<std::string>& list_preloads();

}  // namespace strut
