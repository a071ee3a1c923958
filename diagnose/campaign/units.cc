#include "diagnose/campaign/units.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "base/error/input_error.h"
#include "base/text/nearest_name.h"

namespace strut {
namespace {

struct UnitEntry {
  const char* si;
  const char* name;
  UnitScale scale;
};

constexpr double kGravity = 9.80665;                  // m/s^2, standard gravity
constexpr double kDegree = 0.0174532925199432957692;  // rad
constexpr double kPound = 4.4482216152605;            // N, international pound-force
constexpr double kInch = 0.0254;                      // m, international inch

const std::vector<UnitEntry>& list_units() {
  static const std::vector<UnitEntry> units = {
      {"s", "s", {}},
      {"s", "ms", {1e-3, 0.0}},
      {"s", "us", {1e-6, 0.0}},
      {"s", "min", {60.0, 0.0}},
      {"m", "m", {}},
      {"m", "mm", {1e-3, 0.0}},
      {"m", "cm", {1e-2, 0.0}},
      {"m", "um", {1e-6, 0.0}},
      {"m", "in", {kInch, 0.0}},
      {"m/s", "m/s", {}},
      {"m/s", "mm/s", {1e-3, 0.0}},
      {"m/s", "cm/s", {1e-2, 0.0}},
      {"m/s", "in/s", {kInch, 0.0}},
      {"m/s", "km/h", {1.0 / 3.6, 0.0}},
      {"m/s^2", "m/s^2", {}},
      {"m/s^2", "g", {kGravity, 0.0}},
      {"m/s^2", "mg", {1e-3 * kGravity, 0.0}},
      {"m/s^2", "mm/s^2", {1e-3, 0.0}},
      {"rad", "rad", {}},
      {"rad", "mrad", {1e-3, 0.0}},
      {"rad", "deg", {kDegree, 0.0}},
      {"rad/s", "rad/s", {}},
      {"rad/s", "mrad/s", {1e-3, 0.0}},
      {"rad/s", "deg/s", {kDegree, 0.0}},
      {"rad/s", "mdeg/s", {1e-3 * kDegree, 0.0}},
      {"rad/s", "rpm", {6.0 * kDegree, 0.0}},
      {"N", "N", {}},
      {"N", "kN", {1e3, 0.0}},
      {"N", "mN", {1e-3, 0.0}},
      {"N", "lbf", {kPound, 0.0}},
      {"N", "kgf", {kGravity, 0.0}},
      {"K", "K", {}},
      {"K", "degC", {1.0, 273.15}},
      {"K", "degF", {5.0 / 9.0, 273.15 - 160.0 / 9.0}},
  };
  return units;
}

}  // namespace

UnitScale find_unit_scale(const std::string& unit, const std::string& si) {
  if (unit.empty() || unit == si) return {};
  std::vector<std::string> allowed;
  for (const UnitEntry& entry : list_units()) {
    if (entry.si != si) continue;
    if (entry.name == unit) return entry.scale;
    allowed.emplace_back(entry.name);
  }
  throw InputError(fmt::format("unit \"{}\": unknown for a channel in {}; allowed: {}{}", unit, si,
                               join_names(allowed), suggest_name(unit, allowed)));
}

std::string guess_unit(const std::string& si, double ratio) {
  constexpr double kWithin = 1.0 / 3.0;
  std::string best;
  double nearest = std::log(1.0 + kWithin);
  for (const UnitEntry& entry : list_units()) {
    if (entry.si != si || entry.scale.offset != 0.0) continue;
    const double distance = std::abs(std::log(ratio * entry.scale.factor));
    if (distance >= nearest) continue;
    nearest = distance;
    best = entry.name;
  }
  return best == si ? "" : best;
}

}  // namespace strut
