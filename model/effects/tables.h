// The parts of the catalogue's table; for the catalogue only.
#pragma once

#include "model/effects/catalogue.h"

namespace strut {

inline constexpr ModelSet kCars = static_cast<ModelSet>(ModelKind::kFullVehicle);
inline constexpr ModelSet kQuarterCars = static_cast<ModelSet>(ModelKind::kQuarterCar);
inline constexpr ModelSet kStrutRigs = static_cast<ModelSet>(ModelKind::kStrutRig);
inline constexpr ModelSet kSingleMasses = static_cast<ModelSet>(ModelKind::kSingleMass);
inline constexpr ModelSet kEveryModel = kCars | kQuarterCars | kStrutRigs | kSingleMasses;

/// A parameter at whose zero the effect vanishes.
inline EffectParameter make_switch(const std::string& name, const std::string& unit,
                                   const std::string& description, double low, double high,
                                   double typical, ModelSet models = kEveryModel) {
  return {name, unit, description, 0.0, true, low, high, typical, models};
}

/// A parameter that shapes the effect, of an ordinary size where it is not given.
inline EffectParameter make_shape(const std::string& name, const std::string& unit,
                                  const std::string& description, double ordinary, double low,
                                  double high, double typical, ModelSet models = kEveryModel) {
  return {name, unit, description, ordinary, false, low, high, typical, models};
}

std::vector<EffectInfo> make_strut_effects();   // strut_effects.cc
std::vector<EffectInfo> make_body_effects();    // body_effects.cc: masses, tires, road
std::vector<EffectInfo> make_sensor_effects();  // sensor_effects.cc

/// The channels that a sensor may read in this kind of model.
std::vector<std::string> list_sensor_channels(ModelKind kind);

}  // namespace strut
