// Fitted parameters of a vehicle or rig file: its table [fitted].
//
//   [fitted]                      # by the names of docs/parameters.md; replace the values above
//   front_stiffness = 22313.4
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/error/input_error.h"
#include "io/format/toml_document.h"
#include "model/car/spec.h"
#include "model/rig/rigs.h"

namespace strut {

using FittedValues = std::vector<std::pair<std::string, double>>;

/// Sets the parameters of the table [fitted], if there is one. Throws InputError with file, line,
/// name, value and allowed values, also for parameters of the maneuver and of effects.
void read_fitted(const Table& root, VehicleSpec& vehicle);
void read_fitted(const Table& root, RigSpec& spec);

/// Replaces the table [fitted] in the text of a vehicle or rig file; the other text is unchanged.
std::string replace_fitted(const std::string& text, const FittedValues& values);

}  // namespace strut
