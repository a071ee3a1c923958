#include "model_files/read_fitted.h"

#include "base/text/format_number.h"
#include "model_files/drop_tables.h"
#include "model_files/parameters.h"
#include "model_files/read_rig.h"

namespace strut {

void read_fitted(const Table& root, VehicleSpec& vehicle) {
  if (!root.has("fitted")) return;
  const Table table = root.table("fitted");
  Case c{vehicle, ManeuverSpec{}};
  for (const std::string& name : table.keys()) {
    const double value = table.number(name, find_parameter(name).allowed);
    const ManeuverSpec before = c.maneuver;
    const EffectSettings effects = c.vehicle.effects;
    set_parameter(c, name, value);
    if (c.maneuver == before && c.vehicle.effects == effects) continue;
    throw table.error(name, "is not a parameter of the car itself");
  }
  vehicle = c.vehicle;
}

void read_fitted(const Table& root, RigSpec& spec) {
  if (!root.has("fitted")) return;
  const Table table = root.table("fitted");
  for (const std::string& name : table.keys()) {
    const RigParameter& info = find_rig_parameter(spec.kind, name);
    if (info.is_effect) throw table.error(name, "is not a parameter of the rig itself");
    set_rig_parameter(spec, name, table.number(name, info.allowed));
  }
}

std::string replace_fitted(const std::string& text, const FittedValues& values) {
  std::string changed = drop_tables(text, "fitted");
  if (values.empty()) return changed;
  if (!changed.empty() && changed.back() != '\n') changed += '\n';
  changed += "\n[fitted]\n";
  for (const auto& [name, value] : values) changed += name + " = " + format_number(value) + "\n";
  return changed;
}

}  // namespace strut
