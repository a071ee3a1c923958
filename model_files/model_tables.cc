#include "model_files/model_tables.h"

#include <algorithm>

#include "base/error/input_error.h"
#include "base/text/nearest_name.h"
#include "model/channel/car_channels.h"
#include "model/channel/rig_channels.h"
#include "model_files/parameters.h"
#include "model_files/read_rig.h"
#include "model_files/read_vehicle.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

ModelTables list_car(const std::optional<VehicleSpec>& vehicle) {
  ModelTables tables;
  for (const ParameterInfo& parameter : list_parameters()) {
    std::optional<double> value;
    if (vehicle && !parameter.is_maneuver) value = parameter.get({*vehicle, {}});
    tables.parameters.push_back({&parameter, value});
  }
  tables.channels = list_car_channels();
  return tables;
}

ModelTables list_rig(RigKind kind, const std::optional<RigSpec>& rig) {
  ModelTables tables;
  tables.kind = get_model_kind(kind);
  for (const RigParameter& parameter : list_rig_settings(kind)) {
    std::optional<double> value;
    if (rig) value = parameter.get(*rig);
    tables.parameters.push_back({&parameter, value});
  }
  tables.channels = list_rig_channels(kind);
  for (const RigInputInfo& input : list_rig_inputs(kind)) {
    tables.inputs.push_back({input.name, input.unit, input.description, input.required});
  }
  return tables;
}

ModelTables list_file(const fs::path& path) {
  const auto rig = find_rig_kind(path);
  return rig ? list_rig(*rig, read_rig(path)) : list_car(read_vehicle(path));
}

}  // namespace

ModelTables make_model_tables(const std::string& name_or_file) {
  std::vector<std::string> names;
  for (const ModelKind kind : list_model_kinds()) names.push_back(get_model_kind_name(kind));
  if (name_or_file == names.front()) return list_car({});
  const auto& kinds = list_rig_kinds();
  const auto rig = std::find(kinds.begin(), kinds.end(), name_or_file);
  if (rig != kinds.end()) return list_rig(static_cast<RigKind>(rig - kinds.begin()), {});
  if (fs::exists(name_or_file)) return list_file(name_or_file);
  throw InputError("'" + name_or_file + "': neither a file nor a kind of model" +
                   suggest_name(name_or_file, names) + "; kinds: " + join_names(names));
}

}  // namespace strut
