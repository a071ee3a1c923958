#include "model_files/read_force_maps.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/text/format_number.h"
#include "base/text/range.h"
#include "model_files/drop_tables.h"

namespace strut {
namespace {

const Range kDeflection = between(-10.0, 10.0, "m");
const Range kVelocity = between(-100.0, 100.0, "m/s");
const Range kForce = between(-kMaxMapForce, kMaxMapForce, "N");

void read_range(const Table& table, const std::string& key, const Range& allowed, double& low,
                double& high) {
  const std::vector<double> ends = table.numbers(key, allowed);
  if (ends.size() != 2) throw table.error(key, "must be two numbers, the lower first");
  low = ends[0];
  high = ends[1];
  if (!(low < high)) throw table.error(key, "must be two numbers, the lower first");
}

int read_count(const Table& table, std::size_t count, const std::string& what) {
  if (is_spline_count(count)) return static_cast<int>(count);
  throw table.error("force", fmt::format("has {} {}; allowed: 1 or {} to {}", count, what,
                                         kMinSplines, kMaxSplines));
}

ForceMap read_force_map(const Table& table, const ModelInfo& model) {
  ForceMap map;
  const std::vector<std::string>& places = list_force_map_places(model);
  if (places.size() > 1)
    map.place = places[static_cast<std::size_t>(table.choice("place", places))];
  read_range(table, "deflection", kDeflection, map.deflection_low, map.deflection_high);
  read_range(table, "velocity", kVelocity, map.velocity_low, map.velocity_high);
  const std::vector<std::vector<double>> rows = table.rows("force", kForce);
  map.deflection_count = read_count(table, rows.size(), "rows");
  map.velocity_count = read_count(table, rows.front().size(), "columns");
  for (const std::vector<double>& row : rows) {
    map.coefficients.insert(map.coefficients.end(), row.begin(), row.end());
  }
  return map;
}

std::string write_range(const std::string& key, double low, double high) {
  return fmt::format("{} = [{}, {}]\n", key, format_number(low), format_number(high));
}

std::string write_force_map(const ForceMap& map) {
  std::string text = "[[force_map]]\n";
  if (!map.place.empty()) text += fmt::format("place = \"{}\"\n", map.place);
  text += write_range("deflection", map.deflection_low, map.deflection_high);
  text += write_range("velocity", map.velocity_low, map.velocity_high);
  text += "force = [\n";
  const auto columns = static_cast<std::size_t>(map.velocity_count);
  for (std::size_t i = 0; i < map.coefficients.size(); ++i) {
    text += i % columns == 0 ? "  [" : ", ";
    text += format_number(map.coefficients[i]);
    if ((i + 1) % columns == 0) text += "],\n";
  }
  return text + "]\n";
}

}  // namespace

ForceMaps read_force_maps(const Table& root, const ModelInfo& model) {
  ForceMaps maps;
  if (!root.has("force_map")) return maps;
  for (const Table& table : root.tables("force_map")) {
    maps.push_back(read_force_map(table, model));
    const auto same = [&](const ForceMap& map) { return map.place == maps.back().place; };
    if (std::count_if(maps.begin(), maps.end(), same) == 1) continue;
    const std::string twice = "given twice; allowed: once";
    throw maps.back().place.empty() ? table.error(twice) : table.error("place", twice);
  }
  return maps;
}

std::string replace_force_maps(const std::string& text, const ForceMaps& maps,
                               const ModelInfo& model) {
  validate(maps, model);
  std::string changed = drop_tables(text, "force_map");
  if (!changed.empty() && changed.back() != '\n' && !maps.empty()) changed += '\n';
  for (const ForceMap& map : maps) {
    changed += (changed.empty() ? "" : "\n") + write_force_map(map);
  }
  return changed;
}

}  // namespace strut
