#include "model/effects/force_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/names/corners.h"
#include "base/text/nearest_name.h"
#include "model/effects/names.h"
#include "model/error/model_error.h"

namespace strut {
namespace {

std::size_t to_size(int n) { return static_cast<std::size_t>(n); }

ModelError refuse(const ForceMap& map, const std::string& what) {
  return ModelError("force map" + (map.place.empty() ? "" : " at " + map.place) + ": " + what);
}

void check_range(const ForceMap& map, const std::string& name, double low, double high) {
  if (std::isfinite(low) && std::isfinite(high) && low < high) return;
  throw refuse(
      map, fmt::format("{} = [{:g}, {:g}]: must be two numbers, the lower first", name, low, high));
}

void check_count(const ForceMap& map, const std::string& name, int count) {
  if (count > 0 && is_spline_count(to_size(count))) return;
  throw refuse(map, fmt::format("{} has {} splines; allowed: 1 or {} to {}", name, count,
                                kMinSplines, kMaxSplines));
}

void check_coefficients(const ForceMap& map) {
  const std::size_t wanted = to_size(map.deflection_count) * to_size(map.velocity_count);
  if (map.coefficients.size() != wanted) {
    throw refuse(map,
                 fmt::format("has {} coefficients; allowed: {}", map.coefficients.size(), wanted));
  }
  for (const double force : map.coefficients) {
    if (std::fabs(force) <= kMaxMapForce) continue;
    throw refuse(map, fmt::format("coefficient {:g} N: must lie in [{:g}, {:g}] N", force,
                                  -kMaxMapForce, kMaxMapForce));
  }
}

void check_map(const ForceMap& map, const ModelInfo& model) {
  const std::vector<std::string>& places = list_force_map_places(model);
  if (std::find(places.begin(), places.end(), map.place) == places.end()) {
    throw refuse(map, model.has(kHasCar) ? "place must be one of " + join_names(places)
                                         : "a rig's force map has no place");
  }
  check_range(map, "deflection", map.deflection_low, map.deflection_high);
  check_range(map, "velocity", map.velocity_low, map.velocity_high);
  check_count(map, "deflection", map.deflection_count);
  check_count(map, "velocity", map.velocity_count);
  check_coefficients(map);
}

/// `count` B-splines over the range [low, high].
SplineAxis<double> make_axis(double low, double high, int count) {
  const double cells = std::max(count - 3, 1);
  return {low, cells / (high - low), cells};
}

}  // namespace

const std::vector<std::string>& list_force_map_places(const ModelInfo& model) {
  static const std::vector<std::string> rig_places = {PlaceName::kRig};
  static const std::vector<std::string> car_places = [] {
    std::vector<std::string> places(kAxleNames.begin(), kAxleNames.end());
    places.insert(places.end(), kCornerNames.begin(), kCornerNames.end());
    return places;
  }();
  return model.has(kHasCar) ? car_places : rig_places;
}

void validate(const ForceMaps& maps, const ModelInfo& model) {
  for (const ForceMap& map : maps) {
    check_map(map, model);
    const auto same = [&](const ForceMap& other) { return other.place == map.place; };
    if (std::count_if(maps.begin(), maps.end(), same) > 1) {
      throw refuse(map, "given twice; allowed: once");
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
  abscissas.reserve(to_size(count));
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
  // Where the map does not depend on a variable, the four splines of one cell share one
  // coefficient.
  const std::size_t rows = to_size(std::max(map.deflection_count, kMinSplines));
  const std::size_t columns = to_size(std::max(map.velocity_count, kMinSplines));
  table.stride = static_cast<double>(columns);
  table.coefficients.reserve(rows * columns);
  for (std::size_t i = 0; i < rows; ++i) {
    const std::size_t row = map.deflection_count == 1 ? 0 : i * to_size(map.velocity_count);
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
