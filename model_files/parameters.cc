#include "model_files/parameters.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include "base/text/format_number.h"
#include "base/text/range.h"
#include "io/table/units.h"
#include "model/car/car_info.h"
#include "model/effects/catalogue.h"
#include "model_files/read_effects.h"

namespace strut {

namespace {

const std::string kTable1 = "the paper, Table 1";
const std::string kVehicleFile = "examples/vehicles/paper_sedan.toml, with reasons";
const std::string kTireFile = "examples/tires/paper_sedan.tir, with reasons";
const std::string kPaperText = "the paper, section 3";
const std::string kStrutChoice = "choice of this program";

constexpr std::array<const char*, kAxles> kAxleWords = {"front axle", "rear axle"};
constexpr std::array<const char*, kCorners> kCornerWords = {
    "front left corner", "front right corner", "rear left corner", "rear right corner"};

using Parameters = std::vector<ParameterInfo>;

/// Adds a parameter that is one number of the case; `field` is a function Case& -> double&.
template <class Field>
void add_number(Parameters& list, const std::string& name, double default_value,
                const Range& allowed, const std::string& description, const std::string& source,
                Field field) {
  list.push_back({{name, allowed.unit.empty() ? "1" : allowed.unit, default_value, allowed,
                   description, source},
                  [field](const Case& c) { return field(c); },
                  [field](Case& c, double value) { field(c) = value; }});
}

/// Adds a number of the suspension for each axle.
template <class Field>
void add_per_axle(Parameters& list, const std::string& name, std::array<double, kAxles> defaults,
                  const Range& allowed, const std::string& description, const std::string& source,
                  Field field) {
  for (std::size_t axle = 0; axle < kAxles; ++axle) {
    add_number(
        list, std::string(kAxleNames[axle]) + "_" + name, defaults[axle], allowed,
        description + ", " + kAxleWords[axle], source,
        [ field, axle ](auto& c) -> auto& { return field(c.vehicle.suspension[axle]); });
  }
}

void add_whole_car(Parameters& list) {
  add_number(
      list, "mass", 1155.0, between(200.0, 20000.0, "kg"), "mass of the whole car", kTable1,
      [](auto& c) -> auto& { return c.vehicle.whole.mass; });
  add_number(
      list, "centroid_to_front", 0.7209, between(0.1, 10.0, "m"),
      "distance of the whole car's centroid behind the front axle", kTable1,
      [](auto& c) -> auto& { return c.vehicle.whole.centroid_to_front; });
  add_number(
      list, "centroid_to_rear", 2.0791, between(0.1, 10.0, "m"),
      "distance of the whole car's centroid ahead of the rear axle", kTable1,
      [](auto& c) -> auto& { return c.vehicle.whole.centroid_to_rear; });
  add_number(
      list, "centroid_height", 0.5373, between(0.05, 3.0, "m"),
      "height of the whole car's centroid at nominal trim", kTable1,
      [](auto& c) -> auto& { return c.vehicle.whole.centroid_height; });
  const Range inertia = between(10.0, 200000.0, "kg m^2");
  add_number(
      list, "roll_inertia", 300.0, inertia, "roll inertia of the whole car", kVehicleFile,
      [](auto& c) -> auto& { return c.vehicle.whole.inertia.xx; });
  add_number(
      list, "pitch_inertia", 1560.0, inertia, "pitch inertia of the whole car", kVehicleFile,
      [](auto& c) -> auto& { return c.vehicle.whole.inertia.yy; });
  add_number(
      list, "yaw_inertia", 1700.0, inertia, "yaw inertia of the whole car", kVehicleFile,
      [](auto& c) -> auto& { return c.vehicle.whole.inertia.zz; });
}

void add_sensor_and_steering(Parameters& list) {
  const Range place = between(-5.0, 5.0, "m");
  add_number(
      list, "imu_position_x", 0.0, place, "sensor ahead of the centroid", kVehicleFile,
      [](auto& c) -> auto& { return c.vehicle.imu_position.x; });
  add_number(
      list, "imu_position_y", 0.0, place, "sensor left of the centroid", kVehicleFile,
      [](auto& c) -> auto& { return c.vehicle.imu_position.y; });
  add_number(
      list, "imu_position_z", 0.0, place, "sensor above the centroid", kVehicleFile,
      [](auto& c) -> auto& { return c.vehicle.imu_position.z; });
  add_number(
      list, "rack_position", 0.0, between(-0.05, 0.05, "m"),
      "steering rack to the left, fixed during a run", kStrutChoice,
      [](auto& c) -> auto& { return c.vehicle.rack_position; });
  // The rear wheels get the remaining torque.
  list.push_back({{"front_drive_share", "1", 1.0, between(0.0, 1.0),
                   "fraction of the drive torque on the front wheels", kPaperText},
                  [](const Case& c) { return c.vehicle.suspension[kFront].drive_share; },
                  [](Case& c, double value) {
                    c.vehicle.suspension[kFront].drive_share = value;
                    c.vehicle.suspension[kRear].drive_share = 1.0 - value;
                  }});
}

void add_axles(Parameters& list) {
  add_per_axle(
      list, "half_track", {0.725, 0.80}, between(0.2, 2.0, "m"), "wheel center to center plane",
      kVehicleFile, [](auto& s) -> auto& { return s.wheel_center_y; });
  add_per_axle(
      list, "wheel_mass", {22.0, 22.0}, between(0.5, 500.0, "kg"), "mass of a wheel with tire",
      kVehicleFile, [](auto& s) -> auto& { return s.wheel_mass; });
  add_per_axle(
      list, "wheel_spin_inertia", {1.5, 1.5}, between(0.01, 200.0, "kg m^2"),
      "inertia of a wheel with tire about its axis", kVehicleFile,
      [](auto& s) -> auto& { return s.wheel_spin_inertia; });
  add_per_axle(
      list, "wheel_transverse_inertia", {0.8, 0.8}, between(0.005, 200.0, "kg m^2"),
      "inertia of a wheel with tire about a diameter", kVehicleFile,
      [](auto& s) -> auto& { return s.wheel_transverse_inertia; });
  add_per_axle(
      list, "upright_mass", {18.0, 16.0}, between(0.5, 500.0, "kg"),
      "mass of an upright with hub and brake; its inertia is unchanged", kVehicleFile,
      [](auto& s) -> auto& { return s.upright.mass; });
  const Range angle = between(-0.1, 0.1, "rad");
  add_per_axle(
      list, "static_toe", {0.0, 0.0}, angle, "toe-in of a wheel at nominal trim", kVehicleFile,
      [](auto& s) -> auto& { return s.static_toe; });
  add_per_axle(
      list, "static_camber", {0.0, 0.0}, angle, "camber of a wheel at nominal trim, + top outwards",
      kVehicleFile, [](auto& s) -> auto& { return s.static_camber; });
}

/// Adds a rate of the springs or dampers, which wear lowers, for both corners of each axle, then
/// for each corner.
void add_strut(Parameters& list, const std::string& name, std::array<double, kAxles> defaults,
               const Range& allowed, const std::string& description, double StrutSpec::*field) {
  for (std::size_t axle = 0; axle < kAxles; ++axle) {
    list.push_back({{std::string(kAxleNames[axle]) + "_" + name, allowed.unit, defaults[axle],
                     allowed, description + ", both corners of the " + kAxleWords[axle], kTable1},
                    [axle, field](const Case& c) {
                      const auto& strut = c.vehicle.suspension[axle].strut;
                      return 0.5 * (strut[0].*field + strut[1].*field);
                    },
                    [axle, field](Case& c, double value) {
                      for (StrutSpec& s : c.vehicle.suspension[axle].strut) s.*field = value;
                    }});
    list.back().wears_at = kAxleNames[axle];
  }
  for (std::size_t corner = 0; corner < kCorners; ++corner) {
    const std::size_t axle = corner / 2, side = corner % 2;
    add_number(
        list, std::string(kCornerNames[corner]) + "_" + name, defaults[axle], allowed,
        description + ", " + kCornerWords[corner], kTable1,
        [ axle, side,
          field ](auto& c) -> auto& { return c.vehicle.suspension[axle].strut[side].*field; });
    list.back().wears_at = kCornerNames[corner];
  }
}

void add_struts(Parameters& list) {
  add_strut(list, "stiffness", {40000.0, 35000.0}, between(100.0, 1e6, "N/m"),
            "rate of a coil spring along its axis", &StrutSpec::stiffness);
  add_strut(list, "damping", {1980.0, 1980.0}, between(0.0, 1e5, "N s/m"),
            "rate of a damper along its axis", &StrutSpec::damping);
}

void add_tire(Parameters& list) {
  // Both the contact and the coefficients of the in-plane forces have the free radius.
  list.push_back(
      {{"tire_radius", "m", 0.4673, between(0.1, 2.0, "m"), "free radius of a tire", kTable1},
       [](const Case& c) { return c.vehicle.tire.unloaded_radius; },
       [](Case& c, double value) {
         c.vehicle.tire.unloaded_radius = value;
         c.vehicle.pacejka.UNLOADED_RADIUS = value;
       }});
  add_number(
      list, "tire_stiffness", 200000.0, between(1e4, 1e7, "N/m"), "vertical stiffness of a tire",
      kTireFile, [](auto& c) -> auto& { return c.vehicle.tire.stiffness; });
  add_number(
      list, "tire_damping", 500.0, between(0.0, 1e5, "N s/m"), "vertical damping of a tire",
      kTireFile, [](auto& c) -> auto& { return c.vehicle.tire.damping; });
  add_number(
      list, "footprint", 0.12, between(0.0, 1.0, "m"),
      "contact patch length that smooths short obstacles; 0 or at least 0.02", kVehicleFile,
      [](auto& c) -> auto& { return c.vehicle.tire.footprint; });
}

/// Adds a parameter of the bump's formula, which cannot be set for a table or without a bump.
template <class Field>
void add_bump(Parameters& list, const std::string& name, double default_value, const Range& allowed,
              const std::string& description, Field field) {
  add_number(list, name, default_value, allowed, description, kPaperText, field);
  list.back().set = [field, name](Case& c, double value) {
    const RoadSpec& road = c.maneuver.road;
    if (!road.has_formula()) {
      throw InputError(fmt::format("{}: cannot be set, the maneuver's bump is {}", name,
                                   road.shape == BumpShape::kNone ? "\"none\"" : "a table"));
    }
    field(c) = value;
  };
}

constexpr char kBumpSpacing[] = "bump_spacing";

bool has_bump_row(const Case& c) { return c.maneuver.road.count > 1; }

void add_maneuver(Parameters& list) {
  add_number(
      list, "speed", 20.0, between(0.5, 100.0, "m/s"), "initial forward speed", kPaperText,
      [](auto& c) -> auto& { return c.maneuver.speed; });
  add_number(
      list, "duration", 3.0, between(1e-3, 3600.0, "s"), "simulated time", kPaperText,
      [](auto& c) -> auto& { return c.maneuver.duration; });
  add_number(
      list, "drive_torque", 500.0, between(-20000.0, 20000.0, "N m"), "total drive torque",
      kPaperText, [](auto& c) -> auto& { return c.maneuver.drive_torque; });
  add_number(
      list, "drive_reaction", 1.0, between(0.0, 1.0),
      "fraction of the drive torque that the chassis reacts; 0: it comes from outside", kPaperText,
      [](auto& c) -> auto& { return c.maneuver.drive_reaction; });
  add_number(
      list, "bump_distance", 10.0, between(-1000.0, 10000.0, "m"),
      "bump center ahead of the front wheel centers at the start", kStrutChoice,
      [](auto& c) -> auto& { return c.maneuver.bump_distance; });
  add_number(
      list, "gravity", 9.81, between(0.1, 30.0, "m/s^2"), "gravity", kStrutChoice,
      [](auto& c) -> auto& { return c.maneuver.gravity; });
  add_bump(
      list, "bump_height", 0.05, between(0.0, 0.5, "m"), "height of the bump",
      [](auto& c) -> auto& { return c.maneuver.road.height; });
  add_bump(
      list, "bump_length", 0.4, between(0.001, 20.0, "m"), "length of the bump along the road",
      [](auto& c) -> auto& { return c.maneuver.road.length; });
  add_bump(
      list, "bump_ramp", 0.1, between(0.0005, 10.0, "m"), "length of each flank of a trapezoid",
      [](auto& c) -> auto& { return c.maneuver.road.ramp; });
  add_number(
      list, kBumpSpacing, 2.0, between(0.01, 200.0, "m"),
      "from one bump's center to the next, in a row of bumps", kStrutChoice,
      [](auto& c) -> auto& { return c.maneuver.road.spacing; });
  list.back().set = [](Case& c, double value) {
    if (!has_bump_row(c)) {
      throw InputError(
          fmt::format("{}: cannot be set, the maneuver has no row of bumps (count)", kBumpSpacing));
    }
    c.maneuver.road.spacing = value;
  };
}

void add_effect(Parameters& list, const EffectInfo& effect, const std::string& place) {
  const ModelInfo& car = get_car_info();
  const auto parameters = list_effect_parameters(effect, car);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const EffectParameter& p = *parameters[i];
    const auto get = [&effect, &car, place, i](const Case& c) {
      return get_effect_value(c.vehicle.effects, effect, car, place, i);
    };
    const auto set = [&effect, &car, place, i](Case& c, double value) {
      set_effect_value(c.vehicle.effects, effect, car, place, i, value);
    };
    list.push_back({make_effect_parameter(effect, place, p, car), get, set});
  }
}

Parameters make_parameters() {
  Parameters list;
  add_whole_car(list);
  add_sensor_and_steering(list);
  add_axles(list);
  add_struts(list);
  add_tire(list);
  const std::size_t first_of_maneuver = list.size();
  add_maneuver(list);
  for (std::size_t i = first_of_maneuver; i < list.size(); ++i) list[i].is_maneuver = true;
  for (const EffectInfo& effect : list_effects()) {
    for (const std::string& place : list_effect_places(effect, get_car_info())) {
      add_effect(list, effect, place);
    }
  }
  return list;
}

}  // namespace

const std::vector<ParameterInfo>& list_parameters() {
  static const Parameters list = make_parameters();
  return list;
}

std::vector<const ParameterInfo*> list_parameters_in_use(const Case& c) {
  std::vector<const ParameterInfo*> used;
  for (const ParameterInfo& p : list_parameters()) {
    if (p.name == kBumpSpacing && !has_bump_row(c)) continue;
    if (!p.is_effect || p.get(c) != p.default_value) used.push_back(&p);
  }
  return used;
}

const ParameterInfo& find_parameter(const std::string& name) {
  return find_listed(list_parameters(), name);
}

double get_parameter(const Case& c, const std::string& name) { return find_parameter(name).get(c); }

void set_parameter(Case& c, const std::string& name, double value) {
  const ParameterInfo& parameter = find_parameter(name);
  check_value(parameter, value);
  parameter.set(c, value);
}

double NamedValue::to_si(const std::string& si) const {
  if (unit.empty()) return value;
  if (si.empty()) {
    throw InputError(
        fmt::format("{} = {} {}: must be a number in SI units", name, format_number(value), unit));
  }
  try {
    const UnitScale scale = find_unit_scale(unit, si);
    return scale.factor * value + scale.offset;
  } catch (const InputError& e) {
    throw InputError(fmt::format("{} = {} {}: {}", name, format_number(value), unit, e.what()));
  }
}

NamedValue parse_setting(const std::string& setting) {
  const auto equals = setting.find('=');
  if (equals == std::string::npos) {
    throw InputError(
        fmt::format("'{}': must be name=value, for example front_stiffness=38000", setting));
  }
  const std::string name = setting.substr(0, equals), text = setting.substr(equals + 1);
  NamedValue parsed{name};
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), parsed.value);
  if (error != std::errc()) {
    throw InputError(fmt::format("{} = '{}': must be a number", name, text));
  }
  parsed.unit = normalize_unit(std::string_view(stop, text.data() + text.size()));
  return parsed;
}

void apply_setting(Case& c, const std::string& setting) {
  const NamedValue given = parse_setting(setting);
  set_parameter(c, given.name, given.to_si(find_parameter(given.name).unit));
}

}  // namespace strut
