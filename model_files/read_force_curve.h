// Dampers and tires of vehicle and rig files: a constant rate, or a measured curve.
#pragma once

#include <string>

#include "io/format/toml_document.h"
#include "model/force/force_curve.h"

namespace strut {

/// Reads rows [speed in m/s, force in N], positive in compression; none where the key is absent.
/// Throws InputError as validate_damper_curve, or where `rate_key` is given, too: the curve has a
/// rate of its own.
ForceCurveSpec read_damper_curve(const Table& table, const std::string& key,
                                 const std::string& rate_key);

/// Reads rows [deflection in m, load in N]; otherwise as read_damper_curve.
ForceCurveSpec read_tire_curve(const Table& table, const std::string& key,
                               const std::string& rate_key);

}  // namespace strut
