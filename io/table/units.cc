#include "io/table/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "base/error/input_error.h"
#include "base/text/nearest_name.h"
#include "io/format/text_line.h"

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
constexpr double kFoot = 12.0 * kInch;                // m

const std::vector<UnitEntry>& list_units() {
  static const std::vector<UnitEntry> units = {
      {"s", "s", {}},
      {"s", "ms", {1e-3, 0.0}},
      {"s", "us", {1e-6, 0.0}},
      {"s", "ns", {1e-9, 0.0}},
      {"s", "min", {60.0, 0.0}},
      {"s", "h", {3600.0, 0.0}},
      {"m", "m", {}},
      {"m", "mm", {1e-3, 0.0}},
      {"m", "cm", {1e-2, 0.0}},
      {"m", "um", {1e-6, 0.0}},
      {"m", "in", {kInch, 0.0}},
      {"m", "ft", {kFoot, 0.0}},
      {"m/s", "m/s", {}},
      {"m/s", "mm/s", {1e-3, 0.0}},
      {"m/s", "cm/s", {1e-2, 0.0}},
      {"m/s", "in/s", {kInch, 0.0}},
      {"m/s", "ft/s", {kFoot, 0.0}},
      {"m/s", "km/h", {1.0 / 3.6, 0.0}},
      {"m/s", "mph", {5280.0 * kFoot / 3600.0, 0.0}},
      {"m/s^2", "m/s^2", {}},
      {"m/s^2", "g", {kGravity, 0.0}},
      {"m/s^2", "mg", {1e-3 * kGravity, 0.0}},
      {"m/s^2", "mm/s^2", {1e-3, 0.0}},
      {"m/s^2", "cm/s^2", {1e-2, 0.0}},
      {"m/s^2", "ft/s^2", {kFoot, 0.0}},
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
      {"N", "daN", {10.0, 0.0}},
      {"N", "mN", {1e-3, 0.0}},
      {"N", "lbf", {kPound, 0.0}},
      {"N", "kgf", {kGravity, 0.0}},
      {"N/m", "N/m", {}},
      {"N/m", "N/mm", {1e3, 0.0}},
      {"N/m", "kN/m", {1e3, 0.0}},
      {"N/m", "lbf/in", {kPound / kInch, 0.0}},
      {"N s/m", "N s/m", {}},
      {"N s/m", "N s/mm", {1e3, 0.0}},
      {"N s/m", "kN s/m", {1e3, 0.0}},
      {"kg", "kg", {}},
      {"K", "K", {}},
      {"K", "degC", {1.0, 273.15}},
      {"K", "degF", {5.0 / 9.0, 273.15 - 160.0 / 9.0}},
  };
  return units;
}

/// Other spellings of the units above, after kSigns were replaced.
constexpr std::pair<const char*, const char*> kSpellings[] = {
    {"sec", "s"},         {"Sec", "s"},         {"SEC", "s"},        {"second", "s"},
    {"seconds", "s"},     {"msec", "ms"},       {"usec", "us"},      {"MM", "mm"},
    {"inch", "in"},       {"m/s2", "m/s^2"},    {"m/s/s", "m/s^2"},  {"m/s**2", "m/s^2"},
    {"m/sec^2", "m/s^2"}, {"m/sec2", "m/s^2"},  {"m s^-2", "m/s^2"}, {"mm/s2", "mm/s^2"},
    {"cm/s2", "cm/s^2"},  {"ft/s2", "ft/s^2"},  {"G", "g"},          {"g0", "g"},
    {"m/sec", "m/s"},     {"m s^-1", "m/s"},    {"mm/sec", "mm/s"},  {"kph", "km/h"},
    {"kmh", "km/h"},      {"km/hr", "km/h"},    {"degree", "deg"},   {"degrees", "deg"},
    {"DEG", "deg"},       {"deg/sec", "deg/s"}, {"dps", "deg/s"},    {"rad/sec", "rad/s"},
    {"1/min", "rpm"},     {"KN", "kN"},         {"lb", "lbf"},       {"lbs", "lbf"},
    {"kp", "kgf"},        {"degreeC", "degC"},  {"Celsius", "degC"}, {"C", "degC"},
    {"F", "degF"}};

/// Signs of UTF-8 text and their ASCII form.
constexpr std::pair<std::string_view, std::string_view> kSigns[] = {
    {"\u00b2", "^2"}, {"\u00b5", "u"}, {"\u03bc", "u"}, {"\u00b0", "deg"}};

}  // namespace

std::string normalize_unit(std::string_view unit) {
  std::string text(trim(unit, " \t"));
  for (const auto& [sign, ascii] : kSigns) {
    for (std::size_t at = text.find(sign); at != std::string::npos; at = text.find(sign, at)) {
      text.replace(at, sign.size(), ascii);
      at += ascii.size();
    }
  }
  for (const auto& [spelling, name] : kSpellings) {
    if (text == spelling) return name;
  }
  return text;
}

bool is_known_unit(std::string_view unit) {
  if (unit.size() > kMaxUnitLength) return false;
  const std::string name = normalize_unit(unit);
  return std::any_of(list_units().begin(), list_units().end(),
                     [&](const UnitEntry& entry) { return entry.name == name; });
}

UnitScale find_unit_scale(std::string_view given, const std::string& si) {
  const std::string unit = normalize_unit(given);
  if (unit.empty() || unit == si) return {};
  std::vector<std::string> allowed;
  for (const UnitEntry& entry : list_units()) {
    if (entry.si != si) continue;
    if (entry.name == unit) return entry.scale;
    allowed.emplace_back(entry.name);
  }
  throw InputError(fmt::format("unit \"{}\": unknown for a quantity in {}; allowed: {}{}", unit, si,
                               join_names(allowed), suggest_name(unit, allowed)));
}

std::string name_unit(const std::string& si, double factor) {
  constexpr double kRounding = 1e-12;
  for (const UnitEntry& entry : list_units()) {
    if (entry.si == si && std::abs(entry.scale.factor / factor - 1.0) < kRounding)
      return entry.name;
  }
  return fmt::format("{:g} {}", factor, si);
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
  return best;
}

}  // namespace strut
