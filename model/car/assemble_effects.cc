#include "model/car/assemble_effects.h"

#include <algorithm>
#include <array>

#include "model/car/car_info.h"
#include "model/effects/names.h"
#include "model/effects/strut_numbers.h"

namespace strut {
namespace {

using E = EffectName;

constexpr double kAirDensity = 1.2;  // kg/m^3, at 20 degrees Celsius

/// The effects that apply_case_effects applies.
constexpr std::array<const char*, 6> kCaseEffects = {E::kUnsprungMass,   E::kTireEnveloping,
                                                     E::kBumpHeight,     E::kBumpLength,
                                                     E::kSensorPosition, E::kSpeedError};

bool is_case_effect(const EffectSetting& setting) {
  return std::find(kCaseEffects.begin(), kCaseEffects.end(), setting.effect) != kCaseEffects.end();
}

void scale_bump(double height, double length, RoadSpec& road) {
  road.height *= height;
  road.length *= length;
  road.ramp *= length;
  for (double& z : road.table_z) z *= height;
  for (double& x : road.table_x) x *= length;
}

void set_struts(const VehicleSpec& spec, const EffectValues& values, VehicleLayout& layout,
                VehicleParameters<double>& numbers) {
  for (int axle = 0; axle < kAxles; ++axle) {
    layout.damper_curve[axle] = make_force_curve(spec.suspension[axle].damper_curve);
  }
  for (int c = 0; c < kCorners; ++c) {
    const PlainStrut strut = {numbers.spring[c].stiffness, numbers.damper[c].damping,
                              numbers.nominal_length[c * kLines + kSpringLine]};
    numbers.effects[c] = make_strut_effect_numbers(values, kCornerNames[c], strut);
    layout.strut_effects[c] = find_strut_effects(numbers.effects[c]);
    if (layout.damper_curve[axle_of(c)]) layout.strut_effects[c] |= kShapedDamper;
  }
  for (int axle = 0; axle < kAxles; ++axle) {
    const std::size_t left = 2 * axle * kLines + kSpringLine, right = left + kLines;
    numbers.anti_roll_bar[axle] = {values.get(E::kAntiRollBar, "stiffness", kAxleNames[axle]),
                                   numbers.nominal_length[left] - numbers.nominal_length[right]};
    layout.has_anti_roll_bar[axle] = numbers.anti_roll_bar[axle].stiffness != 0.0;
  }
}

void set_tires(const EffectValues& values, VehicleLayout& layout,
               VehicleParameters<double>& numbers) {
  for (int axle = 0; axle < kAxles; ++axle) {
    const auto get = [&](const char* effect, const char* parameter) {
      return values.get(effect, parameter, kAxleNames[axle]);
    };
    TireVertical<double>& tire = numbers.tire[axle];
    tire.stiffness *= 1.0 + get(E::kTireStiffness, "gain");
    tire.damping = std::max(0.0, tire.damping + get(E::kTireDamping, "rate"));
    tire.progression = get(E::kTireProgressive, "progression");
    layout.progressive_tire = layout.progressive_tire || tire.progression != 0.0;
  }
  for (int c = 0; c < kCorners; ++c) {
    numbers.runout[c] = {values.get(E::kWheelRunout, "amplitude", kCornerNames[c]),
                         values.get(E::kWheelRunout, "phase", kCornerNames[c])};
    layout.has_runout = layout.has_runout || numbers.runout[c].amplitude != 0.0;
  }
}

/// Adds a point mass to a body; the inertia remains about the center of mass.
void add_point_mass(double mass, const Vec3<double>& position, RigidBody<double>& body) {
  const double whole = body.mass + mass;
  if (!(whole > 0.0)) {
    throw ModelError(
        "effect payload: the chassis would have no mass; allowed: more than minus the "
        "mass of the chassis");
  }
  const Vec3<double> lever = position - body.center;
  body.inertia = body.inertia + (0.5 * body.mass * mass / whole) * inertia_form(lever, lever);
  body.center = body.center + (mass / whole) * lever;
  body.mass = whole;
}

void set_body(const VehicleSpec& spec, const EffectValues& values,
              VehicleParameters<double>& numbers) {
  const auto get = [&](const char* effect, const char* parameter) {
    return values.get(effect, parameter, PlaceName::kBody);
  };
  const double mass_ratio = spec.whole.mass / numbers.chassis.mass;
  numbers.chassis.center =
      numbers.chassis.center + Vec3<double>{mass_ratio * get(E::kCenterOfMassShift, "x"), 0.0,
                                            mass_ratio * get(E::kCenterOfMassShift, "z")};
  numbers.chassis.inertia.yy += get(E::kPitchInertia, "gain") * spec.whole.inertia.yy;
  const double load = get(E::kPayload, "mass");
  if (load != 0.0) {
    const Vec3<double> position{get(E::kPayload, "x"), 0.0, get(E::kPayload, "z")};
    add_point_mass(load, position, numbers.chassis);
    numbers.mass += load;
  }
  check_chassis_inertia(numbers.chassis.inertia);
}

void set_lift(const EffectValues& values, VehicleLayout& layout,
              VehicleParameters<double>& numbers) {
  for (int axle = 0; axle < kAxles; ++axle) {
    const double area = values.get(E::kAerodynamicLift, "area", kAxleNames[axle]);
    numbers.lift[axle] = 0.5 * kAirDensity * area;
    layout.has_lift = layout.has_lift || area != 0.0;
  }
}

}  // namespace

Case apply_case_effects(const Case& c) {
  if (std::none_of(c.vehicle.effects.begin(), c.vehicle.effects.end(), is_case_effect)) return c;
  const EffectValues values{c.vehicle.effects, get_car_info()};
  const auto get_road = [&](const char* effect, const char* parameter) {
    return values.get(effect, parameter, PlaceName::kRoad);
  };
  Case changed = c;
  for (int axle = 0; axle < kAxles; ++axle) {
    changed.vehicle.suspension[axle].wheel_mass +=
        values.get(E::kUnsprungMass, "mass", kAxleNames[axle]);
  }
  changed.vehicle.tire.footprint += get_road(E::kTireEnveloping, "length");
  scale_bump(1.0 + get_road(E::kBumpHeight, "gain"), 1.0 + get_road(E::kBumpLength, "gain"),
             changed.maneuver.road);
  changed.maneuver.speed *= 1.0 + get_road(E::kSpeedError, "gain");
  Vec3<double>& sensor = changed.vehicle.imu_position;
  sensor.x += values.get(E::kSensorPosition, "x", PlaceName::kBody);
  sensor.y += values.get(E::kSensorPosition, "y", PlaceName::kBody);
  sensor.z += values.get(E::kSensorPosition, "z", PlaceName::kBody);
  std::erase_if(changed.vehicle.effects, is_case_effect);
  return changed;
}

void set_effects(const VehicleSpec& spec, VehicleLayout& layout,
                 VehicleParameters<double>& numbers) {
  const EffectValues values{spec.effects, get_car_info()};
  set_struts(spec, values, layout, numbers);
  set_tires(values, layout, numbers);
  set_body(spec, values, numbers);
  set_lift(values, layout, numbers);
}

}  // namespace strut
