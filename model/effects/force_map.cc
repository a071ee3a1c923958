#include "model/effects/force_map.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/names/corners.h"
#include "model/error/model_error.h"

namespace strut {
namespace {

ModelError refuse(const ForceMap& map, const std::string& what) {
  return ModelError("force map" + (map.place.empty() ? "" : " at " + map.place) + ": " + what);
}

void check_range(const ForceMap& map, const std::string& name, double low, double high) {
  if (std::isfinite(low) && std::isfinite(high) && low < high) return;
  std::ostringstream message;
  message << name << " = [" << low << ", " << high << "]: must be two numbers, the lower first";
  throw refuse(map, message.str());
}

void check_count(const ForceMap& map, const std::string& name, int count) {
  if (count == 1 || (count >= kFewestSplines && count <= kMostSplines)) return;
  throw refuse(map, name + " has " + std::to_string(count) + " splines; allowed: 1 or " +
                        std::to_string(kFewestSplines) + " to " + std::to_string(kMostSplines));
}

std::size_t count_of(int n) { return static_cast<std::size_t>(n); }

void check_coefficients(const ForceMap& map) {
  const std::size_t wanted = count_of(map.deflection_count) * count_of(map.velocity_count);
  if (map.coefficients.size() != wanted) {
    throw refuse(map, "has " + std::to_string(map.coefficients.size()) +
                          " coefficients; allowed: " + std::to_string(wanted));
  }
  for (const double force : map.coefficients) {
    if (std::fabs(force) <= kLargestMapForce) continue;
    std::ostringstream message;
    message << "coefficient " << force << " N: must lie in [" << -kLargestMapForce << ", "
            << kLargestMapForce << "] N";
    throw refuse(map, message.str());
  }
}

void check_map(const ForceMap& map, const ModelInfo& model) {
  const std::vector<std::string>& places = list_force_map_places(model);
  if (std::find(places.begin(), places.end(), map.place) == places.end()) {
    std::string names;
    for (const std::string& place : places) names += (names.empty() ? "" : ", ") + place;
    throw refuse(map, names.empty() ? "a rig's has no place" : "place must be one of " + names);
  }
  check_range(map, "deflection", map.deflection_low, map.deflection_high);
  check_range(map, "velocity", map.velocity_low, map.velocity_high);
  check_count(map, "deflection", map.deflection_count);
  check_count(map, "velocity", map.velocity_count);
  check_coefficients(map);
}

SplineAxis<double> make_axis(double low, double high, int count) {
  const double cells = std::max(count - 3, 1);
  return {low, cells / (high - low), cells};
}

}  // namespace

const std::vector<std::string>& list_force_map_places(const ModelInfo& model) {
  static const std::vector<std::string> of_rig = {""};
  static const std::vector<std::string> of_car = [] {
    std::vector<std::string> places(kAxleNames.begin(), kAxleNames.end());
    places.insert(places.end(), kCornerNames.begin(), kCornerNames.end());
    return places;
  }();
  return model.has(kHasCar) ? of_car : of_rig;
}

void validate(const ForceMaps& maps, const ModelInfo& model) {
  for (const ForceMap& map : maps) {
    check_map(map, model);
    const auto same = [&](const ForceMap& other) { return other.place == map.place; };
    if (std::count_if(maps.begin(), maps.end(), same) > 1) {
      throw refuse(map, "is there twice; allowed: once");
    }
  }
}

const ForceMap* find_force_map(const ForceMaps& maps, const std::string& place) {
  for (const ForceMap& map : maps) {
    if (map.place == place) return &map;
  }
  const std::size_t cut = place.find('_');
  return cut == std::string::npos ? nullptr : find_force_map(maps, place.substr(0, cut));
}

std::vector<double> calc_map_abscissas(double low, double high, int count) {
  if (count == 1) return {0.5 * (low + high)};
  std::vector<double> abscissas;
  abscissas.reserve(count_of(count));
  for (int i = 0; i < count; ++i) {
    abscissas.push_back(low + (high - low) * (i - 1) / (count - 3));
  }
  return abscissas;
}

double calc_force(const ForceMap& map, double deflection, double velocity) {
  const auto table = make_force_map_table(map);
  const ForceMapTable* const lanes[] = {table.get()};
  MappedForce<double> force = ForceMapPacker().add<double>(lanes, 0.0);
  force.table = table->coefficients.data();
  return force.calc_force({-deflection, -velocity});
}

std::shared_ptr<const ForceMapTable> make_force_map_table(const ForceMap& map) {
  ForceMapTable table;
  table.deflection = make_axis(map.deflection_low, map.deflection_high, map.deflection_count);
  table.velocity = make_axis(map.velocity_low, map.velocity_high, map.velocity_count);
  // Where the map does not depend on a variable all four splines of one cell have one coefficient.
  const std::size_t rows = count_of(std::max(map.deflection_count, kFewestSplines));
  const std::size_t columns = count_of(std::max(map.velocity_count, kFewestSplines));
  table.stride = static_cast<double>(columns);
  table.coefficients.reserve(rows * columns);
  for (std::size_t i = 0; i < rows; ++i) {
    const std::size_t row = map.deflection_count == 1 ? 0 : i * count_of(map.velocity_count);
    for (std::size_t j = 0; j < columns; ++j) {
      table.coefficients.push_back(map.coefficients[row + (map.velocity_count == 1 ? 0 : j)]);
    }
  }
  return std::make_shared<const ForceMapTable>(std::move(table));
}

std::array<std::shared_ptr<const ForceMapTable>, 4> make_corner_force_maps(const ForceMaps& maps) {
  std::array<std::shared_ptr<const ForceMapTable>, 4> tables;
  std::array<const ForceMap*, 4> found{};
  for (std::size_t c = 0; c < tables.size() && !maps.empty(); ++c) {
    found[c] = find_force_map(maps, kCornerNames[c]);
    if (found[c] == nullptr) continue;
    const bool shared = c % 2 == 1 && found[c] == found[c - 1];
    tables[c] = shared ? tables[c - 1] : make_force_map_table(*found[c]);
  }
  return tables;
}

}  // namespace strut
