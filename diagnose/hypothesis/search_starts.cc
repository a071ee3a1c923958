#include "diagnose/hypothesis/search_starts.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <numbers>

#include "base/error/check.h"
#include "model/effects/catalogue.h"
#include "model/effects/names.h"

namespace strut {
namespace {

using Starts = SearchStarts;
using Motion = const StrutMotion&;
using Rule = std::function<Starts(Motion)>;
using Rules = std::map<std::string, Rule>;

/// One size, whatever the motion.
Rule start_at(const char* parameter, double value) {
  return [=](Motion) { return Starts{{{parameter, value}}}; };
}

Starts start_blow_off(Motion m) {
  return {{{"loss", 0.2}, {"knee", 0.3 * m.velocity}},
          {{"loss", 0.2}, {"knee", m.velocity}},
          {{"loss", 0.2}, {"knee", 3.0 * m.velocity}},
          {{"loss", -2.0}, {"knee", 0.5 * m.velocity}}};  // a bleed that is soft at low speed
}

Starts start_bump_stop(Motion m) {
  Starts starts;
  for (const double gap : {0.3, 0.6, 0.85}) {
    starts.push_back({{"stiffness", 0.2 * m.stiffness},
                      {"gap", gap * m.compression},
                      {"progression", 0.5 / m.compression}});
  }
  return starts;
}

/// A stroke far beyond the motion of a reading changes other readings than a short one.
Starts start_stroke(const char* name, Motion m) {
  Starts starts;
  for (const double fraction : {0.02, 0.1, 0.4})
    starts.push_back({{name, fraction * m.deflection}});
  return starts;
}

Starts start_friction(Motion m) {
  const double force = 0.1 * m.damper_force(), speed = 0.05 * m.velocity;
  return {{{"force", force}, {"speed", speed}, {"stroke", 0.0}},
          {{"force", force}, {"speed", speed}, {"stroke", 0.05 * m.deflection}}};
}

Starts start_top_mount(Motion m) {
  return {
      {{"compliance", 0.05 / (m.damping * m.frequency())}, {"relaxation", 0.05 / m.frequency()}}};
}

Starts start_progressive_spring(Motion m) {
  return {{{"cubic", 0.05 / (m.compression * m.compression)}}};
}

/// On the body's middle, over the rear and over the front axle.
Starts start_payload(Motion) {
  return {
      {{"mass", 10.0}, {"x", 0.0}}, {{"mass", 10.0}, {"x", -1.3}}, {{"mass", 10.0}, {"x", 1.3}}};
}

Starts start_runout(Motion) { return {{{"phase", 0.0}}, {{"phase", 0.5 * std::numbers::pi}}}; }

bool has_parameter(const EffectInfo& effect, const std::string& name) {
  return std::any_of(effect.parameters.begin(), effect.parameters.end(),
                     [&](const EffectParameter& p) { return p.name == name; });
}

/// The same rules. A name that the catalogue does not have would begin at a default in silence.
Rules check_rules(Rules rules) {
  for (const auto& [name, rule] : rules) {
    const EffectInfo* effect = find_effect(name);
    STRUT_CHECK(effect != nullptr, "search starts: no effect " + name);
    for (const auto& start : rule({})) {
      for (const auto& [parameter, value] : start) {
        STRUT_CHECK(has_parameter(*effect, parameter),
                    "search starts: " + name + " has no parameter " + parameter);
      }
    }
  }
  return rules;
}

/// By effect. Small sizes that the motion shows, so that a search begins where the effect is seen.
const Rules& list_rules() {
  static const Rules rules =
      check_rules({{EffectName::kDamperAsymmetry, start_at("asymmetry", 0.1)},
                   {EffectName::kDamperBlowOff, start_blow_off},
                   {EffectName::kDamperHysteresis,
                    [](Motion m) -> Starts {
                      return {{{"lag", 0.05 / m.frequency()}}};
                    }},
                   {EffectName::kDamperLeak, [](Motion m) { return start_stroke("stroke", m); }},
                   {EffectName::kDamperFade,
                    [](Motion) -> Starts {
                      return {{{"loss", 0.005}, {"rate", 0.005}}};
                    }},
                   {EffectName::kStrutFriction, start_friction},
                   {EffectName::kProgressiveSpring, start_progressive_spring},
                   {EffectName::kBumpStop, start_bump_stop},
                   {EffectName::kTopMountCompliance, start_top_mount},
                   {EffectName::kJointPlay, [](Motion m) { return start_stroke("play", m); }},
                   {EffectName::kGasForce,
                    [](Motion m) -> Starts {
                      return {{{"force", 0.05 * m.stiffness * m.deflection}}};
                    }},
                   {EffectName::kAntiRollBar,
                    [](Motion m) -> Starts {
                      return {{{"stiffness", 0.05 * m.stiffness}}};
                    }},
                   {EffectName::kTireProgressive,
                    [](Motion m) -> Starts {
                      return {{{"progression", 0.05 / m.tire_deflection}}};
                    }},
                   {EffectName::kTireDamping,
                    [](Motion m) -> Starts {
                      return {{{"rate", 0.1 * m.damping}}};
                    }},
                   {EffectName::kPayload, start_payload},
                   // Errors of road and speed move all readings in time: a car that is 1 % faster
                   // is elsewhere after a second, which no longer is the tangent that runs whose
                   // own speeds are free can take over.
                   {EffectName::kSpeedError, start_at("gain", 5e-4)},
                   {EffectName::kBumpHeight, start_at("gain", 0.01)},
                   {EffectName::kBumpLength, start_at("gain", 5e-3)},
                   {EffectName::kWheelRunout, start_runout},
                   {EffectName::kSensorGain, start_at("gain", 0.01)},
                   {EffectName::kSensorDelay, start_at("delay", 5e-4)},
                   {EffectName::kClockOffset, start_at("offset", 5e-4)},
                   {EffectName::kSensorLowpass, start_at("time", 5e-4)}});
  return rules;
}

}  // namespace

double StrutMotion::frequency() const { return velocity / std::max(deflection, 1e-9); }

double StrutMotion::damper_force() const { return damping * velocity; }

SearchStarts choose_search_starts(const std::string& effect, const StrutMotion& motion) {
  const Rules& rules = list_rules();
  const auto found = rules.find(effect);
  return found == rules.end() ? SearchStarts{{}} : found->second(motion);
}

SearchRange choose_search_range(const std::string& effect, const std::string& parameter,
                                const StrutMotion& motion) {
  constexpr double kKneeOverFastest = 3.0, kGapOverCompression = 0.1;
  SearchRange range;
  if (effect == EffectName::kDamperBlowOff && parameter == "knee" && motion.fastest > 0.0) {
    range.high = kKneeOverFastest * motion.fastest;
  }
  if (effect == EffectName::kBumpStop && parameter == "gap") {
    range.low = kGapOverCompression * motion.compression;
  }
  return range;
}

}  // namespace strut
