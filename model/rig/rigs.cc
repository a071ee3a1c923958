#include "model/rig/rigs.h"

#include <algorithm>
#include <cmath>

#include "model/effects/strut_numbers.h"
#include "model/error/model_error.h"

namespace strut {

namespace {

[[noreturn]] void refuse_input(const RigInfo& rig, const std::string& name) {
  std::string names;
  for (const InputInfo& input : rig.inputs) names += (names.empty() ? "" : ", ") + input.name;
  throw ModelError("input " + name + ": a " + rig.name + " is driven by " + names);
}

/// The rig with its masses as effects make them.
RigSpec apply_mass_effects(const RigSpec& spec) {
  const EffectValues values{spec.effects, get_rig_info(spec.kind)};
  RigSpec changed = spec;
  changed.sprung_mass += values.get("payload", "mass", "");
  changed.unsprung_mass += values.get("unsprung_mass", "mass", "");
  const std::size_t masses = get_rig_info(spec.kind).masses.size();
  const bool wheel = masses < 2 || changed.unsprung_mass > 0.0;
  const bool body = masses == 0 || changed.sprung_mass > 0.0;
  if (wheel && body) return changed;
  throw ModelError(std::string("effect ") + (body ? "unsprung_mass" : "payload") +
                   ": leaves no mass; allowed: more than minus the mass that is there");
}

/// At rest the line has length zero and the spring carries what stands on it, a map's force
/// included.
LinearSpring<double> make_spring(const RigSpec& spec) {
  const bool carries = !get_rig_info(spec.kind).masses.empty();
  double carried = carries ? spec.sprung_mass * spec.gravity : 0.0;
  if (carries && !spec.force_maps.empty()) {
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

std::array<const InputSignal*, kMaxRigInputs> assign_rig_inputs(
    RigKind kind, const std::vector<InputSignal>& inputs) {
  const RigInfo& rig = get_rig_info(kind);
  const std::vector<InputInfo>& known = rig.inputs;
  std::array<const InputSignal*, kMaxRigInputs> assigned{};
  for (const InputSignal& signal : inputs) {
    const int found = find_input(rig, signal.channel);
    if (found < 0) refuse_input(rig, signal.channel);
    const auto at = static_cast<std::size_t>(found);
    if (assigned[at]) throw ModelError("input " + signal.channel + ": is given twice");
    assigned[at] = &signal;
  }
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (!known[i].required || assigned[i]) continue;
    throw ModelError("input " + known[i].name + ": is missing, nothing else moves the rig");
  }
  return assigned;
}

RigSpec take_strut(const RigSpec& rig) {
  RigSpec stand = rig;
  stand.kind = RigKind::kStrutRig;
  std::erase_if(stand.effects, [&](const EffectSetting& setting) {
    const EffectInfo& effect = *find_effect(setting.effect);
    return (effect.places & kOnChannel) != 0 ||
           list_effect_parameters(effect, get_rig_info(rig.kind)) !=
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
  p.effects = make_strut_effect_numbers(values, "", PlainStrut{spec.stiffness, spec.damping, 0.0});
  p.tire = {0.0, spec.tire_stiffness * (1.0 + values.get("tire_stiffness", "gain", "")),
            std::max(0.0, spec.tire_damping + values.get("tire_damping", "rate", "")),
            values.get("tire_progressive", "progression", "")};
  if (rig.has(kHasTire)) {
    p.static_deflection =
        calc_static_deflection((spec.sprung_mass + spec.unsprung_mass) * spec.gravity,
                               p.tire.stiffness, p.tire.progression);
  }
  p.guide = {spec.guide_friction, 1.0 / spec.guide_speed};
  p.ground_gain = 1.0 + values.get("road_gain", "gain", "");
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
