#include "model/effects/strut_numbers.h"

#include <fmt/format.h>

#include "base/error/check.h"
#include "model/effects/names.h"

namespace strut {

double EffectValues::get(const char* effect, const char* parameter,
                         const std::string& place) const {
  const EffectInfo* info = find_effect(effect);
  STRUT_CHECK(info != nullptr, fmt::format("effect {} is not in the catalogue", effect));
  const auto here = list_effect_parameters(*info, model);
  for (std::size_t i = 0; i < here.size(); ++i) {
    if (here[i]->name == parameter) return get_effect_value(settings, *info, model, place, i);
  }
  for (const EffectParameter& p : info->parameters) {
    if (p.name == parameter) return p.neutral;
  }
  throw CheckError(fmt::format("effect {} has no parameter {}", effect, parameter));
}

StrutEffectNumbers<double> make_strut_effect_numbers(const EffectValues& values,
                                                     const std::string& place,
                                                     const PlainStrut& strut) {
  const auto get = [&](const char* effect, const char* parameter) {
    return values.get(effect, parameter, place);
  };
  const double length = strut.nominal_spring_length;
  StrutEffectNumbers<double> n{};
  n.law = {strut.damping,
           get(EffectName::kDamperAsymmetry, "asymmetry"),
           get(EffectName::kDamperBlowOff, "loss"),
           get(EffectName::kDamperBlowOff, "knee"),
           get(EffectName::kDamperFade, "loss"),
           get(EffectName::kDamperFade, "rate")};
  const double joint_play = get(EffectName::kJointPlay, "play");
  n.series = {joint_play + get(EffectName::kDamperLeak, "stroke"),
              get(EffectName::kDamperHysteresis, "lag"),
              get(EffectName::kTopMountCompliance, "compliance"),
              get(EffectName::kTopMountCompliance, "relaxation"), joint_play};
  n.spring = {strut.stiffness * get(EffectName::kProgressiveSpring, "cubic"), length};
  n.stop = {get(EffectName::kBumpStop, "stiffness"), get(EffectName::kBumpStop, "progression"),
            length - get(EffectName::kBumpStop, "gap")};
  n.friction = {get(EffectName::kStrutFriction, "force"),
                1.0 / get(EffectName::kStrutFriction, "speed"),
                get(EffectName::kStrutFriction, "stroke"), joint_play};
  n.gas = {get(EffectName::kGasForce, "force")};
  return n;
}

unsigned find_strut_effects(const StrutEffectNumbers<double>& n) {
  unsigned bits = 0;
  const auto add_if = [&](bool on, unsigned bit) { bits |= on ? bit : 0U; };
  add_if(n.law.asymmetry != 0.0 || n.law.knee_loss != 0.0 || n.law.fade != 0.0 ||
             n.law.warm_fade != 0.0,
         kShapedDamper);
  add_if(n.series.play != 0.0 || n.series.lag != 0.0 || n.series.compliance != 0.0,
         kShapedDamper | kSeriesDamper);
  add_if(n.spring.rate != 0.0, kCubicSpring);
  add_if(n.stop.stiffness != 0.0, kBumpStop);
  add_if(n.friction.force != 0.0, kDryFriction);
  add_if(n.friction.force != 0.0 && n.friction.stroke > 0.0, kShapedDamper | kSeriesDamper);
  add_if(n.gas.force != 0.0, kGasForce);
  return bits;
}

}  // namespace strut
