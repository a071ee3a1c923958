#include "model/rig/rigs.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "model/effects/strut_numbers.h"
#include "model/error/model_error.h"

namespace strut {

namespace {

constexpr double kEarthGravity = 9.81;  // m/s^2, as for the car

RigParameterInfo make_positive(const std::string& name, const std::string& unit, double high,
                               const std::string& description, double RigSpec::*field) {
  return {name, unit, description, 0.0, high, true, std::nullopt, field};
}

RigParameterInfo make_optional(const std::string& name, const std::string& unit, double high,
                               const std::string& description, double fallback,
                               double RigSpec::*field) {
  return {name, unit, description, 0.0, high, false, fallback, field};
}

RigParameterInfo make_gravity(double fallback) {
  return make_optional("gravity", "m/s^2", 100.0, "gravity along the guide", fallback,
                       &RigSpec::gravity);
}

std::vector<RigParameterInfo> make_quarter_car_parameters() {
  using S = RigSpec;
  return {
      make_positive("sprung_mass", "kg", 1e5, "mass on the strut", &S::sprung_mass),
      make_positive("unsprung_mass", "kg", 1e5, "mass between strut and tire", &S::unsprung_mass),
      make_positive("stiffness", "N/m", 1e8, "rate of the strut's spring", &S::stiffness),
      make_optional("damping", "N s/m", 1e6, "rate of the strut's damper", 0.0, &S::damping),
      make_positive("tire_stiffness", "N/m", 1e8, "vertical rate of the tire", &S::tire_stiffness),
      make_optional("tire_damping", "N s/m", 1e6, "vertical damping of the tire", 0.0,
                    &S::tire_damping),
      make_gravity(kEarthGravity)};
}

std::vector<RigParameterInfo> make_strut_rig_parameters() {
  using S = RigSpec;
  return {make_optional("stiffness", "N/m", 1e8, "rate of the strut's spring", 0.0, &S::stiffness),
          make_optional("damping", "N s/m", 1e6, "rate of the strut's damper", 0.0, &S::damping),
          make_optional("temperature", "K", 1000.0, "temperature where no input gives it", 293.15,
                        &S::temperature)};
}

std::vector<RigParameterInfo> make_single_mass_parameters() {
  using S = RigSpec;
  return {
      make_positive("mass", "kg", 1e5, "the mass on the guide", &S::sprung_mass),
      make_optional("stiffness", "N/m", 1e8, "rate of the spring to ground", 0.0, &S::stiffness),
      make_optional("damping", "N s/m", 1e6, "rate of the damper to ground", 0.0, &S::damping),
      make_gravity(0.0)};
}

template <class Info>
const Info& select_kind(RigKind kind, const std::array<Info, 3>& of_kinds) {
  return of_kinds[static_cast<std::size_t>(kind)];
}

int find_input(RigKind kind, const std::string& name) {
  const std::vector<RigInputInfo>& known = list_rig_inputs(kind);
  std::string names;
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (known[i].name == name) return static_cast<int>(i);
    names += (i > 0 ? ", " : "") + known[i].name;
  }
  throw ModelError("input " + name + ": a " + list_rig_kinds()[static_cast<std::size_t>(kind)] +
                   " is driven by " + names);
}

/// The rig with its masses as effects make them.
RigSpec apply_mass_effects(const RigSpec& spec) {
  const EffectValues values{spec.effects, get_model_kind(spec.kind)};
  RigSpec changed = spec;
  changed.sprung_mass += values.get("payload", "mass", "");
  changed.unsprung_mass += values.get("unsprung_mass", "mass", "");
  const bool wheel = spec.kind != RigKind::kQuarterCar || changed.unsprung_mass > 0.0;
  const bool body = spec.kind == RigKind::kStrutRig || changed.sprung_mass > 0.0;
  if (wheel && body) return changed;
  throw ModelError(std::string("effect ") + (body ? "unsprung_mass" : "payload") +
                   ": leaves no mass; allowed: more than minus the mass that is there");
}

/// At rest the line has length zero and the spring carries what stands on it, a map's force
/// included.
LinearSpring<double> make_spring(const RigSpec& spec) {
  double carried = spec.kind == RigKind::kStrutRig ? 0.0 : spec.sprung_mass * spec.gravity;
  if (spec.kind != RigKind::kStrutRig && !spec.force_maps.empty()) {
    carried -= calc_force(spec.force_maps.front(), 0.0, 0.0);
  }
  return {spec.stiffness, spec.stiffness > 0.0 ? carried / spec.stiffness : 0.0};
}

/// x of k (x + q x^2) = load; load >= 0.
double calc_static_deflection(double load, double stiffness, double progression) {
  const double linear = load / stiffness;
  if (progression == 0.0) return linear;
  return 2.0 * linear / (1.0 + std::sqrt(1.0 + 4.0 * progression * linear));
}

}  // namespace

ModelKind get_model_kind(RigKind kind) {
  return list_model_kinds()[1 + static_cast<std::size_t>(kind)];
}

const std::vector<std::string>& list_rig_kinds() {
  static const std::vector<std::string> kinds = {"quarter_car", "strut_rig", "single_mass"};
  return kinds;
}

const std::vector<RigParameterInfo>& list_rig_parameters(RigKind kind) {
  static const std::array<std::vector<RigParameterInfo>, 3> lists = {
      make_quarter_car_parameters(), make_strut_rig_parameters(), make_single_mass_parameters()};
  return select_kind(kind, lists);
}

const std::vector<RigInputInfo>& list_rig_inputs(RigKind kind) {
  static const std::array<std::vector<RigInputInfo>, 3> lists = {
      std::vector<RigInputInfo>{{"road_position", "m", "height of the road", false},
                                {"actuator_force", "N", "pushes the masses apart", false}},
      std::vector<RigInputInfo>{{"displacement", "m", "compression of the strut", true},
                                {"temperature", "K", "of the damper", false}},
      std::vector<RigInputInfo>{{"force", "N", "on the mass, along its position", false}}};
  return select_kind(kind, lists);
}

void validate(const RigSpec& spec) {
  for (const RigParameterInfo& info : list_rig_parameters(spec.kind)) {
    const double value = spec.*info.field;
    const bool above_low = info.open_low ? value > info.low : value >= info.low;
    if (above_low && value <= info.high) continue;
    std::ostringstream message;
    message.precision(17);
    message << info.name << " = " << value << ": must lie in " << (info.open_low ? "(" : "[")
            << info.low << ", " << info.high << "] " << info.unit;
    throw ModelError(message.str());
  }
  validate(spec.effects, get_model_kind(spec.kind));
  validate(spec.force_maps, get_model_kind(spec.kind));
}

std::array<const InputSignal*, kMaxRigInputs> assign_rig_inputs(
    RigKind kind, const std::vector<InputSignal>& inputs) {
  std::array<const InputSignal*, kMaxRigInputs> assigned{};
  for (const InputSignal& signal : inputs) {
    const auto at = static_cast<std::size_t>(find_input(kind, signal.channel));
    if (assigned[at]) throw ModelError("input " + signal.channel + ": is given twice");
    assigned[at] = &signal;
  }
  const std::vector<RigInputInfo>& known = list_rig_inputs(kind);
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (!known[i].required || assigned[i]) continue;
    throw ModelError("input " + known[i].name + ": is missing, nothing else moves the rig");
  }
  return assigned;
}

RigParameters<double> make_rig_parameters(const RigSpec& given) {
  validate(given);
  const RigSpec spec = apply_mass_effects(given);
  RigParameters<double> p{};
  const bool quarter_car = spec.kind == RigKind::kQuarterCar;
  p.mass = {spec.unsprung_mass, spec.sprung_mass};
  if (spec.kind == RigKind::kSingleMass) p.mass = {spec.sprung_mass, 0.0};
  p.initial_position = spec.initial_position;
  p.initial_velocity = spec.initial_velocity;
  p.spring = make_spring(spec);
  p.damper = {spec.damping};
  const EffectValues values{spec.effects, get_model_kind(spec.kind)};
  p.effects = make_strut_effect_numbers(values, "", PlainStrut{spec.stiffness, spec.damping, 0.0});
  p.tire = {0.0, spec.tire_stiffness * (1.0 + values.get("tire_stiffness", "gain", "")),
            std::max(0.0, spec.tire_damping + values.get("tire_damping", "rate", "")),
            values.get("tire_progressive", "progression", "")};
  if (quarter_car) {
    p.static_deflection =
        calc_static_deflection((spec.sprung_mass + spec.unsprung_mass) * spec.gravity,
                               p.tire.stiffness, p.tire.progression);
  }
  p.road_gain = 1.0 + values.get("road_gain", "gain", "");
  p.gravity = spec.gravity;
  p.temperature = spec.temperature;
  return p;
}

RigForceMap make_rig_force_map(const RigSpec& spec) {
  if (spec.force_maps.empty()) return {};
  return {make_force_map_table(spec.force_maps.front())};
}

RigLayout make_rig_layout(const RigSpec* const specs[], const RigParameters<double>* numbers,
                          int count) {
  RigLayout layout{specs[0]->kind, specs[0]->unilateral_tire, 0, false};
  for (int i = 0; i < count; ++i) {
    if (specs[i]->kind != layout.kind || specs[i]->unilateral_tire != layout.unilateral_tire) {
      throw ModelError("rigs of one batch: type and tire contact must be the same");
    }
    layout.strut_effects |= find_strut_effects(numbers[i].effects);
    layout.progressive_tire = layout.progressive_tire || numbers[i].tire.progression != 0.0;
  }
  return layout;
}

}  // namespace strut
