#include "model/car/assemble_effects.h"

#include <algorithm>

#include "model/car/car_info.h"
#include "model/effects/strut_numbers.h"

namespace strut {
namespace {

constexpr double kAirDensity = 1.2;  // kg/m^3, at 20 degrees Celsius

void set_struts(const EffectValues& values, VehicleLayout& layout,
                VehicleParameters<double>& numbers) {
  for (int c = 0; c < kCorners; ++c) {
    const PlainStrut strut = {numbers.spring[c].stiffness, numbers.damper[c].damping,
                              numbers.nominal_length[c * kLines + kSpringLine]};
    numbers.effects[c] = make_strut_effect_numbers(values, kCornerNames[c], strut);
    layout.strut_effects[c] = find_strut_effects(numbers.effects[c]);
  }
  for (int axle = 0; axle < kAxles; ++axle) {
    const std::size_t left = 2 * axle * kLines + kSpringLine;
    numbers.anti_roll_bar[axle] = {
        values.get("anti_roll_bar", "stiffness", kAxleNames[axle]),
        numbers.nominal_length[left] - numbers.nominal_length[left + kLines]};
    layout.has_anti_roll_bar[axle] = numbers.anti_roll_bar[axle].stiffness != 0.0;
  }
}

void set_tires(const EffectValues& values, VehicleLayout& layout,
               VehicleParameters<double>& numbers) {
  for (int axle = 0; axle < kAxles; ++axle) {
    const std::string place = kAxleNames[axle];
    TireVertical<double>& tire = numbers.tire[axle];
    tire.stiffness *= 1.0 + values.get("tire_stiffness", "gain", place);
    tire.damping = std::max(0.0, tire.damping + values.get("tire_damping", "rate", place));
    tire.progression = values.get("tire_progressive", "progression", place);
    layout.progressive_tire = layout.progressive_tire || tire.progression != 0.0;
  }
  for (int c = 0; c < kCorners; ++c) {
    numbers.runout[c] = {values.get("wheel_runout", "amplitude", kCornerNames[c]),
                         values.get("wheel_runout", "phase", kCornerNames[c])};
    layout.has_runout = layout.has_runout || numbers.runout[c].amplitude != 0.0;
  }
}

/// Adds a point mass to a body; inertia stays about the center of mass.
void add_point_mass(double mass, const Vec3<double>& place, RigidBody<double>& body) {
  const double whole = body.mass + mass;
  if (!(whole > 0.0)) throw ModelError("effect payload: leaves the chassis no mass");
  const Vec3<double> lever = place - body.center;
  body.inertia = body.inertia + (0.5 * body.mass * mass / whole) * inertia_form(lever, lever);
  body.center = body.center + (mass / whole) * lever;
  body.mass = whole;
}

void set_body(const VehicleSpec& spec, const EffectValues& values, VehicleLayout& layout,
              VehicleParameters<double>& numbers) {
  const auto get = [&](const char* effect, const char* parameter) {
    return values.get(effect, parameter, "body");
  };
  const double share = spec.whole.mass / numbers.chassis.mass;
  numbers.chassis.center =
      numbers.chassis.center + Vec3<double>{share * get("center_of_mass_shift", "x"), 0.0,
                                            share * get("center_of_mass_shift", "z")};
  numbers.chassis.inertia.yy += get("pitch_inertia", "gain") * spec.whole.inertia.yy;
  const double load = get("payload", "mass");
  if (load != 0.0) {
    add_point_mass(load, {get("payload", "x"), 0.0, get("payload", "z")}, numbers.chassis);
    numbers.mass += load;
  }
  check_chassis_inertia(numbers.chassis.inertia);
  for (int axle = 0; axle < kAxles; ++axle) {
    const double area = values.get("aerodynamic_lift", "area", kAxleNames[axle]);
    numbers.lift[axle] = 0.5 * kAirDensity * area;
    layout.has_lift = layout.has_lift || area != 0.0;
  }
}

bool is_of_case(const EffectSetting& setting) {
  static const std::array<const char*, 6> names = {"unsprung_mass",   "tire_enveloping",
                                                   "bump_height",     "bump_length",
                                                   "sensor_position", "speed_error"};
  return std::find(names.begin(), names.end(), setting.effect) != names.end();
}

void scale_bump(double height, double length, RoadSpec& road) {
  road.height *= height;
  road.length *= length;
  road.ramp *= length;
  for (double& z : road.table_z) z *= height;
  for (double& x : road.table_x) x *= length;
}

}  // namespace

Case apply_case_effects(const Case& c) {
  if (std::none_of(c.vehicle.effects.begin(), c.vehicle.effects.end(), is_of_case)) return c;
  Case changed = c;
  const EffectValues values{c.vehicle.effects, get_car_info()};
  for (int axle = 0; axle < kAxles; ++axle) {
    changed.vehicle.suspension[axle].wheel_mass +=
        values.get("unsprung_mass", "mass", kAxleNames[axle]);
  }
  changed.vehicle.tire.footprint += values.get("tire_enveloping", "length", "road");
  scale_bump(1.0 + values.get("bump_height", "gain", "road"),
             1.0 + values.get("bump_length", "gain", "road"), changed.maneuver.road);
  changed.maneuver.speed *= 1.0 + values.get("speed_error", "gain", "road");
  Vec3<double>& sensor = changed.vehicle.imu_position;
  sensor.x += values.get("sensor_position", "x", "body");
  sensor.y += values.get("sensor_position", "y", "body");
  sensor.z += values.get("sensor_position", "z", "body");
  std::erase_if(changed.vehicle.effects, is_of_case);
  return changed;
}

void set_effects(const VehicleSpec& spec, VehicleLayout& layout,
                 VehicleParameters<double>& numbers) {
  const EffectValues values{spec.effects, get_car_info()};
  set_struts(values, layout, numbers);
  set_tires(values, layout, numbers);
  set_body(spec, values, layout, numbers);
}

}  // namespace strut
