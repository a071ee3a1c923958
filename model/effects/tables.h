// The parts of the catalogue's table; for the catalogue only.
#pragma once

#include "model/effects/catalogue.h"
#include "model/effects/names.h"

namespace strut {

/// A parameter whose neutral value 0 switches the effect off.
inline EffectParameter make_switch(const std::string& name, const std::string& unit,
                                   const std::string& description, double low, double high,
                                   double typical, unsigned needs = 0) {
  return {name, unit, description, 0.0, true, low, high, typical, needs};
}

/// A parameter that shapes the effect, with a default for files without it.
inline EffectParameter make_shape(const std::string& name, const std::string& unit,
                                  const std::string& description, double default_value, double low,
                                  double high, double typical, unsigned needs = 0) {
  return {name, unit, description, default_value, false, low, high, typical, needs};
}

std::vector<EffectInfo> make_strut_effects();   // strut_effects.cc
std::vector<EffectInfo> make_body_effects();    // body_effects.cc: masses, tires, road
std::vector<EffectInfo> make_sensor_effects();  // sensor_effects.cc

}  // namespace strut
