// The parts of the catalogue's table; for the catalogue only.
#pragma once

#include "model/effects/catalogue.h"

namespace strut {

/// A parameter at whose zero the effect vanishes.
inline EffectParameter make_switch(const std::string& name, const std::string& unit,
                                   const std::string& description, double low, double high,
                                   double typical, unsigned needs = 0) {
  return {name, unit, description, 0.0, true, low, high, typical, needs};
}

/// A parameter that shapes the effect, of an ordinary size where it is not given.
inline EffectParameter make_shape(const std::string& name, const std::string& unit,
                                  const std::string& description, double ordinary, double low,
                                  double high, double typical, unsigned needs = 0) {
  return {name, unit, description, ordinary, false, low, high, typical, needs};
}

std::vector<EffectInfo> make_strut_effects();   // strut_effects.cc
std::vector<EffectInfo> make_body_effects();    // body_effects.cc: masses, tires, road
std::vector<EffectInfo> make_sensor_effects();  // sensor_effects.cc

}  // namespace strut
