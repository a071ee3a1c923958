#include "model_files/model_tables.h"

#include <fmt/format.h>

#include <set>

#include "base/error/input_error.h"
#include "base/text/nearest_name.h"
#include "model_files/read_model.h"

namespace strut {
namespace {

/// An effect's parameter that has the name of one of the model's own is not listed: the name means
/// the model's.
ModelTables list_kind(const ModelInfo& info) {
  ModelTables tables{&info, {}};
  std::set<std::string> names;
  for (const Parameter* parameter : list_parameters(info)) {
    if (names.insert(parameter->name).second) tables.parameters.push_back({parameter, {}});
  }
  return tables;
}

ModelTables list_file(const std::filesystem::path& path) {
  const Model model = read_model(path);
  ModelTables tables = list_kind(model.info());
  for (ListedParameter& listed : tables.parameters) {
    if (!listed.parameter->is_maneuver) listed.value = get_parameter(model, listed.parameter->name);
  }
  return tables;
}

}  // namespace

ModelTables make_model_tables(const std::string& name_or_file) {
  std::vector<std::string> names;
  for (const ModelInfo* info : list_models()) {
    if (info->name == name_or_file) return list_kind(*info);
    names.push_back(info->name);
  }
  if (std::filesystem::exists(name_or_file)) return list_file(name_or_file);
  throw InputError(fmt::format("'{}': neither a file nor a kind of model{}; kinds: {}",
                               name_or_file, suggest_name(name_or_file, names), join_names(names)));
}

}  // namespace strut
