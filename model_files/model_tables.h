// The parameters, channels and inputs of a kind of model; of a file with its own values.
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
  std::optional<double> value;  // in the file; nothing where there is none or it does not say
};

struct ModelTables {
  const ModelInfo* model;                   // its channels and inputs
  std::vector<ListedParameter> parameters;  // those of effects last
};

/// The tables of a kind of model, by its name ("full_vehicle", "quarter_car", ...) or by a file of
/// a vehicle or rig. Throws InputError where it is neither, or as reading the file does.
ModelTables make_model_tables(const std::string& name_or_file);

/// docs/parameters.md, docs/channels.md and docs/effects.md, of every kind of model.
std::string write_parameters_document();
std::string write_channels_document();
std::string write_effects_document();

}  // namespace strut
