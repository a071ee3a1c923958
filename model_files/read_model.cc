#include "model_files/read_model.h"

#include "model_files/parameters.h"
#include "model_files/read_rig.h"
#include "model_files/read_vehicle.h"

namespace strut {
namespace {

/// The rig of this kind; null for the car.
const RigInfo* find_rig(const ModelInfo& model) {
  for (const RigInfo& rig : list_rigs()) {
    if (&rig == &model) return &rig;
  }
  return nullptr;
}

template <class Listed>
std::vector<const Parameter*> list_all(const std::vector<Listed>& table) {
  std::vector<const Parameter*> list;
  list.reserve(table.size());
  for (const Listed& parameter : table) list.push_back(&parameter);
  return list;
}

struct Get {
  const std::string& name;
  double operator()(const Case& c) const { return get_parameter(c, name); }
  double operator()(const RigCase& c) const {
    return find_rig_parameter(c.rig.kind, name).get(c.rig);
  }
};

/// Sets the current value again, which throws for parameters that the maneuver's bump does not
/// have; every parameter of a rig can be set.
struct RequireSettable {
  const std::string& name;
  void operator()(Case c) const { set_parameter(c, name, get_parameter(c, name)); }
  void operator()(const RigCase&) const {}
};

struct Set {
  const std::string& name;
  double value;
  void operator()(Case& c) const { set_parameter(c, name, value); }
  void operator()(RigCase& c) const { set_rig_parameter(c.rig, name, value); }
};

}  // namespace

const ModelInfo& read_model_info(const std::filesystem::path& path) {
  const auto rig = find_rig_kind(path);
  return rig ? get_rig_info(*rig) : get_car_info();
}

Model read_model(const std::filesystem::path& path) {
  if (find_rig(read_model_info(path)) != nullptr) return RigCase{read_rig(path), {}};
  return Case{read_vehicle(path), {}};
}

std::vector<const Parameter*> list_parameters(const ModelInfo& model) {
  const RigInfo* rig = find_rig(model);
  return rig != nullptr ? list_all(list_rig_parameters(rig->kind)) : list_all(list_parameters());
}

const Parameter& find_parameter(const ModelInfo& model, const std::string& name) {
  if (const RigInfo* rig = find_rig(model)) return find_rig_parameter(rig->kind, name);
  return find_parameter(name);
}

double get_parameter(const Model& model, const std::string& name) { return model.visit(Get{name}); }

void require_settable(const Model& model, const std::string& name) {
  model.visit(RequireSettable{name});
}

void set_parameter(Model& model, const std::string& name, double value) {
  model.visit(Set{name, value});
}

}  // namespace strut
