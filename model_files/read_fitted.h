// Parameters of a vehicle or rig file that a fit has found: its table [fitted].
//
//   [fitted]                      # by the names of docs/parameters.md; replace what stands above
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
/// name, value and what is allowed; parameters of a maneuver or of effects are not a model's.
void read_fitted(const Table& root, VehicleSpec& vehicle);
void read_fitted(const Table& root, RigSpec& spec);

/// `text`, that of a vehicle or rig file, with its table [fitted] replaced; all else as it stands.
std::string replace_fitted(const std::string& text, const FittedValues& values);

}  // namespace strut
