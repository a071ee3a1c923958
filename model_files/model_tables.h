// What a kind of model has: parameters, channels, inputs; of a file with its own values.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "model/channel/channel_info.h"
#include "model/effects/catalogue.h"
#include "model_files/parameter.h"

namespace strut {

struct ListedParameter {
  const Parameter* parameter;
  std::optional<double> value;  // in the file; nothing where there is none or it does not say
};

struct ListedInput {
  std::string name, unit, description;
  bool required = false;
};

struct ModelTables {
  ModelKind kind = ModelKind::kFullVehicle;
  std::vector<ListedParameter> parameters;  // those of effects last
  std::vector<ChannelInfo> channels;
  std::vector<ListedInput> inputs;  // none of a car: its road is in the maneuver
};

/// The tables of a kind of model, by its name ("full_vehicle", "quarter_car", ...) or by a file of
/// a vehicle or rig. Throws InputError where it is neither, or as reading the file does.
ModelTables make_model_tables(const std::string& name_or_file);

/// docs/parameters.md and docs/channels.md, of every kind of model.
std::string write_parameters_document();
std::string write_channels_document();

}  // namespace strut
