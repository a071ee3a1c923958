#include "diagnose/hypothesis/hypothesis.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "diagnose/baseline/model_states.h"
#include "diagnose/campaign/spread.h"
#include "model_files/parameters.h"
#include "model_files/read_rig.h"

namespace strut {
namespace {

/// How a strut moved, and what its springs and dampers did about it.
struct StrutMotion {
  double compression = 0.0;  // m, the most
  double deflection = 0.0;   // m rms
  double velocity = 0.0;     // m/s rms
  double stiffness = 0.0, damping = 0.0, tire_deflection = 0.0;

  double frequency() const { return velocity / std::max(deflection, 1e-9); }  // rad/s
  double damper_force() const { return damping * velocity; }
};

bool starts_with(const std::string& text, const std::string& head) {
  return text.rfind(head, 0) == 0;
}

std::string find_axle(const std::string& place) {
  return starts_with(place, "front") ? "front" : starts_with(place, "rear") ? "rear" : "";
}

double get_shared_parameter(const CampaignData& data, const SharedValues& shared,
                            const std::string& name) {
  for (std::size_t i = 0; i < shared.unknowns.size(); ++i) {
    if (shared.unknowns[i].name == name) return shared.values[i];
  }
  return data.is_rig() ? get_rig_parameter(data.rigs[0].setup, name)
                       : get_parameter(data.cars[0].setup, name);
}

/// By axle; "" on a rig.
std::map<std::string, StrutMotion> measure_motion(const CampaignData& data,
                                                  const SharedValues& shared) {
  std::map<std::string, StrutMotion> motions;
  double runs = 0.0;
  for (const std::size_t r : data.list_runs(RunUse::kFit)) {
    const RunEvaluation evaluation{
        "", {}, {}, simulate_run(data, r, shared.unknowns, shared.values), {}};
    if (!evaluation.curves.failure.empty()) continue;
    ++runs;
    for (const StateCurve& state : list_states(data, evaluation.curves)) {
      StrutMotion& m = motions[data.is_rig() ? "" : find_axle(state.name)];
      const double spread = calc_spread(state.values);
      if (state.name.find("deflection") != std::string::npos ||
          state.name.find("position") != std::string::npos ||
          state.name.find("displacement") != std::string::npos) {
        m.deflection += spread * spread;
        for (const double v : state.values) {
          if (std::isfinite(v)) m.compression = std::max(m.compression, v);
        }
      } else if (state.name.find("velocity") != std::string::npos) {
        m.velocity += spread * spread;
      } else {
        m.tire_deflection += spread * spread;
      }
    }
  }
  for (auto& [axle, m] : motions) {
    const std::string head = axle.empty() ? "" : axle + "_";
    m.deflection = std::sqrt(m.deflection / std::max(runs, 1.0));
    m.velocity = std::sqrt(m.velocity / std::max(runs, 1.0));
    m.stiffness = get_shared_parameter(data, shared, head + "stiffness");
    m.damping = get_shared_parameter(data, shared, head + "damping");
    m.tire_deflection = std::sqrt(m.tire_deflection / std::max(runs, 1.0));
    if (data.campaign.rig == RigKind::kQuarterCar) {
      m.tire_deflection /= get_shared_parameter(data, shared, "tire_stiffness");
    } else {
      constexpr double kTireStiffness = 2e5;  // N/m, an ordinary car's
      m.tire_deflection /= kTireStiffness;
    }
  }
  return motions;
}

using Beginnings = std::vector<std::map<std::string, double>>;

/// Sizes by the names of the effect's parameters; what is left out is `kShare` of the typical.
Beginnings choose_beginnings(const std::string& effect, const StrutMotion& m) {
  if (effect == "damper_asymmetry") return {{{"asymmetry", 0.1}}};
  if (effect == "damper_blow_off") {
    return {{{"loss", 0.2}, {"knee", 0.3 * m.velocity}},
            {{"loss", 0.2}, {"knee", m.velocity}},
            {{"loss", 0.2}, {"knee", 3.0 * m.velocity}},
            {{"loss", -2.0}, {"knee", 0.5 * m.velocity}}};  // a bleed that is soft at low speed
  }
  if (effect == "damper_hysteresis") return {{{"lag", 0.05 / m.frequency()}}};
  if (effect == "damper_leak") return {{{"stroke", 0.02 * m.deflection}}};
  if (effect == "damper_fade") return {{{"loss", 0.005}, {"rate", 0.005}}};
  if (effect == "strut_friction") {
    return {{{"force", 0.1 * m.damper_force()}, {"speed", 0.05 * m.velocity}}};
  }
  if (effect == "progressive_spring") {
    return {{{"cubic", 0.05 / (m.compression * m.compression)}}};
  }
  if (effect == "bump_stop") {
    Beginnings list;
    for (const double gap : {0.3, 0.6, 0.85}) {
      list.push_back({{"stiffness", 0.2 * m.stiffness},
                      {"gap", gap * m.compression},
                      {"progression", 0.5 / m.compression}});
    }
    return list;
  }
  if (effect == "top_mount_compliance") {
    return {
        {{"compliance", 0.05 / (m.damping * m.frequency())}, {"relaxation", 0.05 / m.frequency()}}};
  }
  if (effect == "joint_play") return {{{"play", 0.02 * m.deflection}}};
  if (effect == "gas_force") return {{{"force", 0.05 * m.stiffness * m.deflection}}};
  if (effect == "anti_roll_bar") return {{{"stiffness", 0.05 * m.stiffness}}};
  if (effect == "tire_progressive") return {{{"progression", 0.05 / m.tire_deflection}}};
  if (effect == "tire_damping") return {{{"rate", 0.1 * m.damping}}};
  if (effect == "payload") {
    return {
        {{"mass", 10.0}, {"x", 0.0}}, {{"mass", 10.0}, {"x", -1.3}}, {{"mass", 10.0}, {"x", 1.3}}};
  }
  if (effect == "wheel_runout") return {{{"phase", 0.0}}, {{"phase", 1.5707963267948966}}};
  if (effect == "sensor_gain") return {{{"gain", 0.01}}};
  if (effect == "sensor_delay") return {{{"delay", 5e-4}}};
  if (effect == "sensor_lowpass") return {{{"time", 5e-4}}};
  return {{}};
}

/// Whether a rig's own parameter says the same: its tire's stiffness is the effect's.
bool is_own_parameter(const CampaignData& data, const std::string& name) {
  if (!data.is_rig()) return false;
  const auto& settings = list_rig_settings(*data.campaign.rig);
  return std::any_of(settings.begin(), settings.end(),
                     [&](const RigParameter& p) { return p.name == name && !p.is_effect; });
}

/// Whether `place` is another name for `other`, an axle or one of its corners.
bool overlaps(const std::string& place, const std::string& other) {
  return starts_with(place, other) || starts_with(other, place);
}

bool is_compared(const CampaignData& data, const std::string& channel) {
  for (const std::size_t r : data.list_runs(RunUse::kFit)) {
    for (const MeasuredChannel& c : data.channels(r)) {
      if (data.info(c.channel).name == channel) return true;
    }
  }
  return false;
}

std::vector<std::vector<double>> make_beginnings(
    const std::vector<const EffectParameter*>& parameters, const Beginnings& chosen) {
  constexpr double kShare = 0.2;
  std::vector<std::vector<double>> beginnings;
  for (const auto& values : chosen) {
    beginnings.emplace_back();
    for (const EffectParameter* p : parameters) {
      const auto found = values.find(p->name);
      double value = p->switches ? p->neutral + kShare * (p->typical - p->neutral) : p->typical;
      if (found != values.end()) value = found->second;
      beginnings.back().push_back(std::clamp(value, p->low, p->high));
    }
  }
  return beginnings;
}

}  // namespace

std::string describe_effect(const std::string& effect, const std::string& place) {
  return effect + (place.empty() ? "" : " at " + place);
}

std::string Hypothesis::describe() const { return describe_effect(effect, place); }

std::vector<Unknown> make_unknowns(const CampaignData& data, const Hypothesis& h) {
  std::vector<Unknown> unknowns;
  unknowns.reserve(h.parameters.size());
  for (const HypothesisParameter& p : h.parameters) {
    unknowns.push_back(data.is_rig() ? make_rig_unknown(data.rigs, p.name)
                                     : make_parameter(data.cars, p.name));
  }
  return unknowns;
}

bool is_plausible(const CampaignData& data, const Hypothesis& h,
                  const std::vector<double>& values) {
  constexpr double kMost = 10.0;
  if (data.is_rig()) return true;
  const auto parameters = list_effect_parameters(*find_effect(h.effect), get_model_kind(data));
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const EffectParameter& p = *parameters[i];
    if (p.switches && std::abs(values[i] - p.neutral) > kMost * std::abs(p.typical - p.neutral)) {
      return false;
    }
  }
  return true;
}

bool is_corner(const std::string& place) { return find_corner(place) >= 0; }

ModelKind get_model_kind(const CampaignData& data) {
  return data.is_rig() ? get_model_kind(*data.campaign.rig) : ModelKind::kFullVehicle;
}

EffectSettings list_effects_on(const CampaignData& data, const SharedValues& shared) {
  if (data.is_rig()) {
    return set_rig_unknowns(data.rigs[0], shared.unknowns, shared.values).setup.effects;
  }
  Case c = data.cars[0].setup;
  set_parameters(c, shared.unknowns, shared.values);
  return c.vehicle.effects;
}

std::vector<Hypothesis> list_hypotheses(const CampaignData& data, const SharedValues& shared,
                                        const EffectSettings& model_effects,
                                        const std::vector<Unknown>& free) {
  const std::map<std::string, StrutMotion> motions = measure_motion(data, shared);
  const ModelKind kind = get_model_kind(data);
  std::vector<Hypothesis> list;
  for (const EffectInfo& effect : list_effects()) {
    if (effect.name == "sensor_bias") continue;  // a bias of every run and channel is always free
    const auto parameters = list_effect_parameters(effect, kind);
    for (const std::string& place : list_effect_places(effect, kind)) {
      const bool is_on =
          std::any_of(model_effects.begin(), model_effects.end(), [&](const EffectSetting& s) {
            return s.effect == effect.name && overlaps(s.place, place);
          });
      if (is_on) continue;
      if ((effect.places & kOnChannel) != 0 && !is_compared(data, place)) continue;
      const auto motion = motions.find(data.is_rig() ? "" : find_axle(place));
      Hypothesis h{effect.name, place, {}, {}};
      for (const EffectParameter* p : parameters) {
        h.parameters.push_back(
            {make_effect_parameter_name(effect, place, *p, kind), p->name, p->switches});
      }
      if (is_own_parameter(data, h.parameters.front().name)) continue;
      const bool is_free = std::any_of(free.begin(), free.end(), [&](const Unknown& u) {
        return std::any_of(h.parameters.begin(), h.parameters.end(),
                           [&](const HypothesisParameter& p) { return p.name == u.name; });
      });
      if (is_free) continue;
      h.beginnings = make_beginnings(
          parameters,
          choose_beginnings(effect.name, motion == motions.end() ? StrutMotion{} : motion->second));
      list.push_back(std::move(h));
    }
  }
  return list;
}

}  // namespace strut
