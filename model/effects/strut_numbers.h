// From settings to the numbers of a strut's elements.
#pragma once

#include "model/effects/catalogue.h"
#include "model/force/strut_effects.h"

namespace strut {

/// Reads values of settings by name.
struct EffectValues {
  const EffectSettings& settings;
  const ModelInfo& model;

  /// The value at a place, neutral where there is no such setting or this kind of model does not
  /// have the parameter.
  double get(const char* effect, const char* parameter, const std::string& place) const;
};

/// The strut that effects act on.
struct PlainStrut {
  double stiffness;              // N/m
  double damping;                // N s/m
  double nominal_spring_length;  // m, of its line where deflection counts from
};

/// All effects of the strut at a place; each neutral where it is off.
StrutEffectNumbers<double> make_strut_effect_numbers(const EffectValues& values,
                                                     const std::string& place,
                                                     const PlainStrut& strut);

/// Which elements those numbers need: StrutEffectBits.
unsigned find_strut_effects(const StrutEffectNumbers<double>& numbers);

}  // namespace strut
