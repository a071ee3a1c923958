// The parameters of a strut's force elements from effect settings.
#pragma once

#include "model/effects/catalogue.h"
#include "model/force/strut_effects.h"

namespace strut {

/// Access to the values of settings by name.
struct EffectValues {
  const EffectSettings& settings;
  const ModelInfo& model;

  /// The value at a place; neutral where there is no such setting or this kind of model does not
  /// have the parameter. Throws CheckError for an unknown effect (EffectName) or parameter.
  double get(const char* effect, const char* parameter, const std::string& place) const;
};

/// The strut that effects act on.
struct PlainStrut {
  double stiffness;              // N/m
  double damping;                // N s/m
  double nominal_spring_length;  // m, spring line at zero deflection
};

/// Parameters of all effects of the strut at a place; neutral for those that are off.
StrutEffectNumbers<double> make_strut_effect_numbers(const EffectValues& values,
                                                     const std::string& place,
                                                     const PlainStrut& strut);

/// The elements that these numbers need, as StrutEffectBits.
unsigned find_strut_effects(const StrutEffectNumbers<double>& numbers);

}  // namespace strut
