// The parameters, channels and inputs of a kind of model or of a model file, with its values.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "model/info/model_info.h"
#include "model/info/parameter.h"

namespace strut {

struct ListedParameter {
  const Parameter* parameter;
  std::optional<double> value;  // in the file; nothing without a file, and for the maneuver
};

struct ModelTables {
  const ModelInfo* model;                   // its channels and inputs
  std::vector<ListedParameter> parameters;  // those of effects last
};

/// The tables of a kind of model ("full_vehicle", "quarter_car", ...) or of a vehicle or rig file.
/// Throws InputError for any other name, and as the reader of the file.
ModelTables make_model_tables(const std::string& name_or_file);

/// The text of docs/parameters.md, docs/channels.md and docs/effects.md, for every kind of model.
std::string write_parameters_document();
std::string write_channels_document();
std::string write_effects_document();

}  // namespace strut
