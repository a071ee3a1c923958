#include "model/rig/rigs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error/check.h"
#include "base/text/nearest_name.h"
#include "model/effects/names.h"
#include "model/effects/strut_numbers.h"
#include "model/error/model_error.h"

namespace strut {

namespace {

using E = EffectName;

double get_value(const EffectValues& values, const char* effect, const char* parameter) {
  return values.get(effect, parameter, PlaceName::kRig);
}

[[noreturn]] void refuse_input(const RigInfo& rig, const std::string& name) {
  std::vector<std::string> names;
  for (const InputInfo& input : rig.inputs) names.push_back(input.name);
  throw ModelError(
      fmt::format("input {}: unknown; inputs of a {}: {}", name, rig.name, join_names(names)));
}

/// The rig with the masses after its effects.
RigSpec apply_mass_effects(const RigSpec& spec) {
  const EffectValues values{spec.effects, get_rig_info(spec.kind)};
  RigSpec changed = spec;
  changed.sprung_mass += get_value(values, E::kPayload, "mass");
  changed.unsprung_mass += get_value(values, E::kUnsprungMass, "mass");
  const std::size_t masses = get_rig_info(spec.kind).masses.size();
  const bool has_wheel_mass = masses < 2 || changed.unsprung_mass > 0.0;
  const bool has_body_mass = masses == 0 || changed.sprung_mass > 0.0;
  if (has_wheel_mass && has_body_mass) return changed;
  throw ModelError(fmt::format(
      "effect {}: the rig's mass would not be positive; allowed: more than minus its mass",
      has_body_mass ? E::kUnsprungMass : E::kPayload));
}

/// At rest the line has length zero, and the spring carries the weight above it less the force of
/// the map.
LinearSpring<double> make_spring(const RigSpec& spec) {
  const bool carries_mass = !get_rig_info(spec.kind).masses.empty();
  double load = carries_mass ? spec.sprung_mass * spec.gravity : 0.0;
  if (carries_mass && !spec.force_maps.empty()) {
    load -= calc_force(spec.force_maps.front(), 0.0, 0.0);
  }
  return {spec.stiffness, spec.stiffness > 0.0 ? load / spec.stiffness : 0.0};
}

}  // namespace

std::array<const InputSignal*, kMaxRigInputs> assign_rig_inputs(
    RigKind kind, const std::vector<InputSignal>& inputs) {
  const RigInfo& rig = get_rig_info(kind);
  const std::vector<InputInfo>& known = rig.inputs;
  STRUT_CHECK(known.size() <= kMaxRigInputs, rig.name + " has more inputs than kMaxRigInputs");
  std::array<const InputSignal*, kMaxRigInputs> assigned{};
  for (const InputSignal& signal : inputs) {
    const int found = find_input(rig, signal.channel);
    if (found < 0) refuse_input(rig, signal.channel);
    const auto at = static_cast<std::size_t>(found);
    if (assigned[at]) {
      throw ModelError(fmt::format("input {}: given twice; allowed: once", signal.channel));
    }
    assigned[at] = &signal;
  }
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (!known[i].required || assigned[i]) continue;
    throw ModelError(
        fmt::format("input {}: missing; the motion of a {} needs it", known[i].name, rig.name));
  }
  return assigned;
}

RigSpec take_strut(const RigSpec& rig) {
  RigSpec stand = rig;
  stand.kind = RigKind::kStrutRig;
  std::erase_if(stand.effects, [&](const EffectSetting& setting) {
    const EffectInfo& effect = *find_effect(setting.effect);
    return is_of_sensors(effect) || list_effect_parameters(effect, get_rig_info(rig.kind)) !=
                                        list_effect_parameters(effect, get_rig_info(stand.kind));
  });
  return stand;
}

RigParameters<double> make_rig_parameters(const RigSpec& given) {
  validate(given);
  const RigSpec spec = apply_mass_effects(given);
  RigParameters<double> p{};
  const RigInfo& rig = get_rig_info(spec.kind);
  p.mass = {spec.unsprung_mass, spec.sprung_mass};
  if (rig.masses.size() == 1) p.mass = {spec.sprung_mass, 0.0};
  p.initial_position = spec.initial_position;
  p.initial_velocity = spec.initial_velocity;
  p.spring = make_spring(spec);
  p.damper = {spec.damping};
  const EffectValues values{spec.effects, rig};
  p.effects = make_strut_effect_numbers(values, PlaceName::kRig,
                                        PlainStrut{spec.stiffness, spec.damping, 0.0});
  p.tire = {0.0, spec.tire_stiffness * (1.0 + get_value(values, E::kTireStiffness, "gain")),
            std::max(0.0, spec.tire_damping + get_value(values, E::kTireDamping, "rate")),
            get_value(values, E::kTireProgressive, "progression")};
  if (rig.has(kHasTire)) {
    p.static_deflection =
        calc_static_deflection(p.tire, make_force_curve(spec.tire_curve).get(),
                               (spec.sprung_mass + spec.unsprung_mass) * spec.gravity);
  }
  const double inverse_speed = 1.0 / spec.guide_speed;
  p.guide = {{{spec.unsprung_guide_friction, inverse_speed, spec.guide_stroke},
              {spec.guide_friction, inverse_speed, spec.guide_stroke}}};
  if (rig.masses.size() == 1) p.guide[0] = p.guide[1];
  p.guide_asymmetry = spec.guide_asymmetry;
  p.moving_mass = spec.moving_mass;
  p.feedback = {spec.deflection_feedback, spec.sprung_velocity_feedback,
                spec.tire_deflection_feedback, spec.unsprung_velocity_feedback};
  p.ground_gain = 1.0 + get_value(values, E::kRoadGain, "gain");
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
  RigLayout layout{.kind = specs[0]->kind, .unilateral_tire = specs[0]->unilateral_tire};
  const auto is_on = [](double value) { return value != 0.0; };
  for (int i = 0; i < count; ++i) {
    if (specs[i]->kind != layout.kind || specs[i]->unilateral_tire != layout.unilateral_tire ||
        specs[i]->damper_curve != specs[0]->damper_curve ||
        specs[i]->tire_curve != specs[0]->tire_curve) {
      throw ModelError("rigs of one batch must have the same type, tire contact and curves");
    }
    layout.strut_effects |= find_strut_effects(numbers[i].effects);
    layout.progressive_tire = layout.progressive_tire || numbers[i].tire.progression != 0.0;
    layout.has_guide =
        layout.has_guide || numbers[i].guide[0].force != 0.0 || numbers[i].guide[1].force != 0.0;
    layout.has_flanks = layout.has_flanks || (layout.has_guide && specs[i]->guide_stroke > 0.0);
    const auto& feedback = numbers[i].feedback;
    layout.has_feedback =
        layout.has_feedback || std::any_of(feedback.begin(), feedback.end(), is_on);
  }
  layout.damper_curve = make_force_curve(specs[0]->damper_curve);
  if (layout.damper_curve) layout.strut_effects |= kShapedDamper;
  layout.tire_curve = make_force_curve(specs[0]->tire_curve);
  return layout;
}

}  // namespace strut
