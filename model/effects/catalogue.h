// The catalogue of effects: named extensions of the model, each with physical parameters, a neutral
// value at which it vanishes, and the places where it may act. Listed once: vehicle and rig files,
// settings, axes of a grid, unknowns of a fit, hypotheses and docs/effects.md derive from the list.
//
// An effect describes a deviation of the real car or rig from its model. The geometry remains that
// of the file; the car finds a new equilibrium. Several effects may act at one place.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "model/effects/setting.h"
#include "model/info/model_info.h"

namespace strut {

/// Kinds of places in a car where an effect may act; bits of a set. A rig has one place of each
/// kind, without a name, but for channels.
enum EffectPlaces : unsigned {
  kOnAxle = 1,      // "front", "rear": both corners, unless a corner has a setting of its own
  kOnCorner = 2,    // "front_left", ...
  kOnBody = 4,      // "body"
  kOnRoad = 8,      // "road": the maneuver
  kOnChannel = 16,  // the channel a sensor reads
  kOnChannels = 32  // all channels of a rig together, on one clock
};

struct EffectParameter {
  std::string name, unit, description;  // unit "1" if none
  double neutral;                       // value where a setting does not give one
  bool switches;     // the effect vanishes where all such parameters are neutral; others shape it
  double low, high;  // the plausible range; a value outside of it is an input error
  double typical;    // typical magnitude in a car, the start value of searches
  unsigned needs = 0, without = 0;  // ModelPart: parts that the model must and must not have
  bool exists_in(const ModelInfo& model) const {
    return (model.parts & needs) == needs && (model.parts & without) == 0;
  }
  /// Start value of a search: a fifth of the typical size of a parameter that switches the effect,
  /// so that the search may end on either side; the typical value of one that shapes it.
  double calc_start() const { return switches ? neutral + 0.2 * (typical - neutral) : typical; }
};

struct EffectInfo {
  std::string name, description, equation, source;
  unsigned places;  // EffectPlaces
  std::vector<EffectParameter> parameters;
};

/// Whether it changes readings only, not the motion.
inline bool is_of_sensors(const EffectInfo& effect) {
  return (effect.places & (kOnChannel | kOnChannels)) != 0;
}

/// All effects in the order of the documentation.
const std::vector<EffectInfo>& list_effects();

/// Null where no effect has this name.
const EffectInfo* find_effect(std::string_view name);

/// The same for the effect of a setting, which the catalogue has.
inline bool is_sensor_setting(const EffectSetting& setting) {
  return is_of_sensors(*find_effect(setting.effect));
}

/// The parameters that exist in this kind of model, in order; empty where the effect does not
/// exist.
std::vector<const EffectParameter*> list_effect_parameters(const EffectInfo& effect,
                                                           const ModelInfo& model);

/// The names of the places where it may act: {""} on a rig; empty where the effect does not exist.
std::vector<std::string> list_effect_places(const EffectInfo& effect, const ModelInfo& model);

/// `<place>_<effect>` where the effect has one parameter in this kind of model, else
/// `<place>_<effect>_<parameter>`; without the place on a rig.
std::string make_effect_parameter_name(const EffectInfo& effect, const std::string& place,
                                       const EffectParameter& parameter, const ModelInfo& model);

/// A setting whose every parameter is neutral.
EffectSetting make_neutral_setting(const EffectInfo& effect, const std::string& place,
                                   const ModelInfo& model);

/// Whether the setting leaves the model unchanged, bit for bit.
bool is_neutral(const EffectSetting& setting, const ModelInfo& model);

/// Throws ModelError with the allowed values for unknown effects and places, duplicate settings, a
/// wrong number of values, and values out of range.
void validate(const EffectSettings& settings, const ModelInfo& model);

/// The value of a parameter at a place; at a corner without a setting of its own the axle's value;
/// at an axle the mean of its corners; neutral without any setting. `parameter` is an index of
/// list_effect_parameters.
double get_effect_value(const EffectSettings& settings, const EffectInfo& effect,
                        const ModelInfo& model, const std::string& place,
                        std::size_t parameter = 0);

/// Sets the value; at an axle for both corners. Settings that have become redundant are removed, so
/// that equal models compare equal.
void set_effect_value(EffectSettings& settings, const EffectInfo& effect, const ModelInfo& model,
                      const std::string& place, std::size_t parameter, double value);

}  // namespace strut
