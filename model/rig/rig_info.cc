#include "model/rig/rig_info.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "base/text/format_number.h"
#include "model/error/model_error.h"

namespace strut {
namespace {

constexpr double kEarthGravity = 9.81;  // m/s^2, as for the car

RigField make_field(const std::string& name, const std::string& unit, double high,
                    const std::string& description, double RigSpec::*field) {
  RigField f;
  f.name = name;
  f.unit = unit;
  f.allowed = {.low = 0.0, .high = high, .open_low = true, .unit = unit};
  f.description = description;
  f.field = field;
  return f;
}

/// An optional parameter. A search from zero starts with one unit of it.
RigField make_optional(const std::string& name, const std::string& unit, double high,
                       const std::string& description, double default_value,
                       double RigSpec::*field) {
  RigField f = make_field(name, unit, high, description, field);
  f.allowed.open_low = false;
  f.default_value = default_value;
  f.typical = 1.0;
  return f;
}

/// An optional parameter of either sign, 0 by default.
RigField make_signed(const std::string& name, const std::string& unit, double reach,
                     const std::string& description, double RigSpec::*field) {
  RigField f = make_optional(name, unit, reach, description, 0.0, field);
  f.allowed.low = -reach;
  return f;
}

/// Dry friction of masses on guides that stand on the ground.
void add_guide(std::vector<RigField>& fields) {
  using S = RigSpec;
  constexpr double kMaxFriction = 1e5;
  const bool has_wheel = std::any_of(fields.begin(), fields.end(), [](const RigField& f) {
    return f.field == &RigSpec::unsprung_mass;
  });
  fields.push_back(make_optional("guide_friction", "N", kMaxFriction,
                                 has_wheel ? "dry friction between sprung mass and guide"
                                           : "dry friction between mass and guide",
                                 0.0, &S::guide_friction));
  if (has_wheel) {
    fields.push_back(make_optional("unsprung_guide_friction", "N", kMaxFriction,
                                   "dry friction between unsprung mass and guide", 0.0,
                                   &S::unsprung_guide_friction));
  }
  fields.push_back(make_signed("guide_asymmetry", "1", 1.0,
                               "a: the guide's friction is (1 + a) times as large upwards, (1 - a) "
                               "times downwards",
                               &S::guide_asymmetry));
  fields.back().typical = 0.1;
  fields.push_back(make_optional("guide_speed", "m/s", 10.0,
                                 "speed at which 76 % of the guide's friction acts", 0.01,
                                 &S::guide_speed));
  fields.back().allowed.open_low = true;
  fields.push_back(make_optional("guide_stroke", "m", 0.02,
                                 "stroke over which the guide's friction builds up elastically; 0: "
                                 "at once",
                                 0.0, &S::guide_stroke));
  fields.back().typical = 5e-4;
}

/// Gains of a controlled force between the masses, by the four states of a quarter car's linear
/// quadratic regulator (Hrovat, Automatica 33, 1997).
void add_feedback(std::vector<RigField>& fields) {
  using S = RigSpec;
  constexpr double kMaxGain = 1e7;
  for (const auto& [name, unit, state, field] :
       {std::tuple{"deflection_feedback", "N/m", "sprung less unsprung position",
                   &S::deflection_feedback},
        std::tuple{"sprung_velocity_feedback", "N s/m", "sprung velocity",
                   &S::sprung_velocity_feedback},
        std::tuple{"tire_deflection_feedback", "N/m", "unsprung less road position",
                   &S::tire_deflection_feedback},
        std::tuple{"unsprung_velocity_feedback", "N s/m", "unsprung velocity",
                   &S::unsprung_velocity_feedback}}) {
    fields.push_back(make_signed(
        name, unit, kMaxGain,
        std::string("of a controlled force that pushes the masses apart: gain by the ") + state,
        field));
  }
}

RigField make_gravity(double default_value) {
  return make_optional("gravity", "m/s^2", 100.0, "gravity along the guide", default_value,
                       &RigSpec::gravity);
}

StateInfo make_deflection(const std::string& name, ChannelSum sum) {
  return {StateKind::kDeflection, "", name, "m", std::move(sum)};
}
StateInfo make_velocity(const std::string& name, ChannelSum sum) {
  return {StateKind::kVelocity, "", name, "m/s", std::move(sum)};
}

// --- quarter_car -----------------------------------------------------------------------------

std::vector<RigField> list_quarter_car_fields() {
  using S = RigSpec;
  std::vector<RigField> fields = {
      make_field("sprung_mass", "kg", 1e5, "mass on the strut", &S::sprung_mass),
      make_field("unsprung_mass", "kg", 1e5, "mass between strut and tire", &S::unsprung_mass),
      make_field("stiffness", "N/m", 1e8, "rate of the strut's spring", &S::stiffness),
      make_optional("damping", "N s/m", 1e6, "rate of the strut's damper", 0.0, &S::damping),
      make_field("tire_stiffness", "N/m", 1e8, "vertical rate of the tire", &S::tire_stiffness),
      make_optional("tire_damping", "N s/m", 1e6, "vertical damping of the tire", 0.0,
                    &S::tire_damping),
      make_gravity(kEarthGravity)};
  add_guide(fields);
  add_feedback(fields);
  return fields;
}

RigInfo make_quarter_car() {
  using C = QuarterCarChannel;
  RigInfo info;
  info.kind = RigKind::kQuarterCar;
  info.name = "quarter_car";
  info.parts = kHasTire | kHasGroundInput | kHasSprungMass;
  info.channels = {{"time", "s", "time since the start"},
                   {"road_position", "m", "height of the road under the tire"},
                   {"unsprung_position", "m", "unsprung mass, from rest"},
                   {"sprung_position", "m", "sprung mass, from rest"},
                   {"road_velocity", "m/s", "rate of road_position"},
                   {"unsprung_velocity", "m/s", "unsprung mass"},
                   {"sprung_velocity", "m/s", "sprung mass"},
                   {"road_acceleration", "m/s^2", "rate of road_velocity"},
                   {"unsprung_acceleration", "m/s^2", "unsprung mass, gravity not included"},
                   {"sprung_acceleration", "m/s^2", "sprung mass, gravity not included"},
                   {"actuator_force", "N", "between the masses, pushes them apart"},
                   {"spring_force", "N", "strut's spring, positive in compression"},
                   {"damper_force", "N", "strut's damper, positive in compression"},
                   {"tire_force", "N", "of the road on the tire, upwards, static load included"}};
  info.inputs = {{.name = "road_position",
                  .unit = "m",
                  .description = "height of the road under the tire",
                  .is_ground = true,
                  .rate = C::kRoadVelocity,
                  .second_rate = C::kRoadAcceleration},
                 {.name = "actuator_force",
                  .unit = "N",
                  .description = "between the masses, positive where it pushes them apart",
                  .is_command = true}};
  info.masses = {{C::kUnsprungPosition, C::kUnsprungVelocity},
                 {C::kSprungPosition, C::kSprungVelocity}};
  const ChannelSum deflection = {{C::kUnsprungPosition, 1.0}, {C::kSprungPosition, -1.0}};
  const ChannelSum velocity = {{C::kUnsprungVelocity, 1.0}, {C::kSprungVelocity, -1.0}};
  info.struts = {{"", "suspension_deflection", "suspension_velocity", deflection, velocity,
                  C::kSpringForce, C::kDamperForce}};
  info.states = {make_deflection("suspension_deflection", deflection),
                 make_velocity("suspension_velocity", velocity),
                 {StateKind::kTireLoad, "", "tire_load", "N", {{C::kTireForce, 1.0}}}};
  info.fields = list_quarter_car_fields();
  info.calc_fastest_mode = [](const RigSpec& spec) {
    const double feedback =
        std::abs(spec.deflection_feedback) + std::abs(spec.tire_deflection_feedback);
    const double tire = spec.tire_stiffness * calc_peak_slope_ratio(spec.tire_curve);
    return std::sqrt((spec.stiffness + tire + feedback) / spec.unsprung_mass);
  };
  return info;
}

// --- strut_rig -------------------------------------------------------------------------------

std::vector<RigField> list_strut_rig_fields() {
  using S = RigSpec;
  return {make_optional("stiffness", "N/m", 1e8, "rate of the strut's spring", 0.0, &S::stiffness),
          make_optional("damping", "N s/m", 1e6, "rate of the strut's damper", 0.0, &S::damping),
          make_optional("moving_mass", "kg", 1e4,
                        "mass that is moved between the load cell and the strut: a clevis, a rod "
                        "or the whole of a driven mass",
                        0.0, &S::moving_mass),
          make_optional("temperature", "K", 1000.0, "temperature where no input gives it", 293.15,
                        &S::temperature)};
}

RigInfo make_strut_rig() {
  using C = StrutRigChannel;
  RigInfo info;
  info.kind = RigKind::kStrutRig;
  info.name = "strut_rig";
  info.parts = kHasDamperTemperature | kHasStaticForce;
  info.channels = {
      {"time", "s", "time since the start"},
      {"displacement", "m", "compression of the strut"},
      {"velocity", "m/s", "rate of displacement"},
      {"acceleration", "m/s^2", "rate of velocity"},
      {"force", "N", "force on the strut and the moving mass, positive in compression"},
      {"spring_force", "N", "strut's spring, positive in compression"},
      {"damper_force", "N", "strut's damper, positive in compression"},
      {"temperature", "K", "temperature of the damper, as given"}};
  info.inputs = {{.name = "displacement",
                  .unit = "m",
                  .description = "compression of the strut",
                  .required = true,
                  .rate = C::kVelocity,
                  .second_rate = C::kAcceleration},
                 {.name = "temperature",
                  .unit = "K",
                  .description = "temperature of the damper",
                  .moves = false}};
  const ChannelSum deflection = {{C::kDisplacement, 1.0}}, velocity = {{C::kVelocity, 1.0}};
  info.struts = {
      {"", "displacement", "velocity", deflection, velocity, C::kSpringForce, C::kDamperForce}};
  info.states = {make_deflection("displacement", deflection), make_velocity("velocity", velocity)};
  info.stand_force = C::kForce;
  info.fields = list_strut_rig_fields();
  info.calc_fastest_mode = [](const RigSpec&) { return 0.0; };
  return info;
}

// --- single_mass -----------------------------------------------------------------------------

double calc_single_mode(const RigSpec& spec) {
  return std::sqrt(spec.stiffness / spec.sprung_mass);
}

std::vector<RigField> list_single_mass_fields() {
  using S = RigSpec;
  std::vector<RigField> fields = {
      make_field("mass", "kg", 1e5, "the mass on the guide", &S::sprung_mass),
      make_optional("stiffness", "N/m", 1e8, "rate of the spring to ground", 0.0, &S::stiffness),
      make_optional("damping", "N s/m", 1e6, "rate of the damper to ground", 0.0, &S::damping),
      make_gravity(0.0)};
  add_guide(fields);
  return fields;
}

RigInfo make_single_mass() {
  using C = SingleMassChannel;
  RigInfo info;
  info.kind = RigKind::kSingleMass;
  info.name = "single_mass";
  info.parts = kHasSprungMass;
  info.channels = {{"time", "s", "time since the start"},
                   {"position", "m", "displacement of the mass from rest"},
                   {"velocity", "m/s", "rate of position"},
                   {"acceleration", "m/s^2", "rate of velocity"},
                   {"force", "N", "applied to the mass, as given"},
                   {"spring_force", "N", "spring to ground, positive in compression"},
                   {"damper_force", "N", "damper to ground, positive in compression"},
                   {"guide_force", "N", "friction of the guide on the mass, upwards"}};
  info.inputs = {
      {.name = "force", .unit = "N", .description = "force on the mass, along its position"}};
  info.masses = {{C::kPosition, C::kVelocity}};
  // The strut is compressed as the mass moves down.
  info.struts = {{"",
                  "deflection",
                  "deflection_velocity",
                  {{C::kPosition, -1.0}},
                  {{C::kVelocity, -1.0}},
                  C::kSpringForce,
                  C::kDamperForce}};
  info.states = {make_deflection("position", {{C::kPosition, 1.0}}),
                 make_velocity("velocity", {{C::kVelocity, 1.0}})};
  info.fields = list_single_mass_fields();
  info.calc_fastest_mode = calc_single_mode;
  return info;
}

// --- guided_mass -----------------------------------------------------------------------------

std::vector<RigField> list_guided_mass_fields() {
  using S = RigSpec;
  std::vector<RigField> fields = {
      make_field("mass", "kg", 1e5, "the mass on the guide", &S::sprung_mass),
      make_field("stiffness", "N/m", 1e8, "rate of the spring to the base", &S::stiffness),
      make_optional("damping", "N s/m", 1e6, "rate of the damper to the base", 0.0, &S::damping),
      make_gravity(0.0)};
  add_guide(fields);
  return fields;
}

RigInfo make_guided_mass() {
  using C = GuidedMassChannel;
  RigInfo info;
  info.kind = RigKind::kGuidedMass;
  info.name = "guided_mass";
  info.parts = kHasGroundInput | kHasSprungMass;
  info.channels = {{"time", "s", "time since the start"},
                   {"base_position", "m", "height of the base under the strut"},
                   {"position", "m", "displacement of the mass from rest"},
                   {"base_velocity", "m/s", "rate of base_position"},
                   {"velocity", "m/s", "rate of position"},
                   {"base_acceleration", "m/s^2", "rate of base_velocity"},
                   {"acceleration", "m/s^2", "rate of velocity, gravity not included"},
                   {"force", "N", "applied to the mass, as given"},
                   {"spring_force", "N", "strut's spring, positive in compression"},
                   {"damper_force", "N", "strut's damper, positive in compression"},
                   {"guide_force", "N", "friction of the guide on the mass, upwards"}};
  info.inputs = {
      {.name = "base_position",
       .unit = "m",
       .description = "height of the base",
       .is_ground = true,
       .rate = C::kBaseVelocity,
       .second_rate = C::kBaseAcceleration},
      {.name = "force", .unit = "N", .description = "force on the mass, along its position"}};
  info.masses = {{C::kPosition, C::kVelocity}};
  const ChannelSum deflection = {{C::kBasePosition, 1.0}, {C::kPosition, -1.0}};
  const ChannelSum velocity = {{C::kBaseVelocity, 1.0}, {C::kVelocity, -1.0}};
  info.struts = {{"", "strut_deflection", "strut_velocity", deflection, velocity, C::kSpringForce,
                  C::kDamperForce}};
  info.states = {make_deflection("strut_deflection", deflection),
                 make_velocity("strut_velocity", velocity),
                 {StateKind::kGuideVelocity, "", "velocity", "m/s", {{C::kVelocity, 1.0}}}};
  info.fields = list_guided_mass_fields();
  info.calc_fastest_mode = calc_single_mode;
  return info;
}

/// Marks time, and the inputs with their derivatives.
RigInfo mark_given(RigInfo info) {
  for (ChannelInfo& channel : info.channels) {
    channel.is_given =
        channel.name == "time" || find_input_derivative(info, channel.name).input >= 0;
  }
  return info;
}

}  // namespace

const std::vector<RigInfo>& list_rigs() {
  static const std::vector<RigInfo> rigs = {
      mark_given(make_quarter_car()), mark_given(make_strut_rig()), mark_given(make_single_mass()),
      mark_given(make_guided_mass())};
  return rigs;
}

void validate(const RigSpec& spec) {
  const RigInfo& rig = get_rig_info(spec.kind);
  for (const RigField& field : rig.fields) {
    const double value = spec.*field.field;
    if (field.allowed.contains(value)) continue;
    throw ModelError(field.name + " = " + format_number(value) + ": " + field.allowed.describe());
  }
  validate_damper_curve(spec.damper_curve);
  validate_tire_curve(spec.tire_curve);
  validate(spec.effects, rig);
  validate(spec.force_maps, rig);
}

}  // namespace strut
