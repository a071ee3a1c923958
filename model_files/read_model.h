// Models of any kind: reading from files, parameters by name.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "model/model.h"
#include "model_files/parameter.h"

namespace strut {

/// The kind that a file's `type` names; the full vehicle for an unknown or missing type, which
/// read_vehicle then refuses. Throws InputError where the file cannot be parsed.
const ModelInfo& read_model_info(const std::filesystem::path& path);

/// Reads the file of a rig, without inputs, or of a vehicle, with the default ManeuverSpec. Throws
/// as read_rig and read_vehicle.
Model read_model(const std::filesystem::path& path);

/// Every parameter of a kind of model; those of effects last.
std::vector<const Parameter*> list_parameters(const ModelInfo& model);

/// Throws InputError with the nearest known name.
const Parameter& find_parameter(const ModelInfo& model, const std::string& name);

double get_parameter(const Model& model, const std::string& name);

/// Throws InputError for a parameter that this model's maneuver does not have.
void require_settable(const Model& model, const std::string& name);

/// Throws InputError with name, value and allowed range.
void set_parameter(Model& model, const std::string& name, double value);

}  // namespace strut
