// The catalogue of effects: named extensions of the model, each with physical parameters, a neutral
// value at which it vanishes, and the places where it may act. Listed once: vehicle and rig files,
// settings, axes of a grid, unknowns of a fit, hypotheses and docs/effects.md derive from the list.
//
// An effect says how the real thing deviates from its model: the geometry is that of the file, the
// car finds its new equilibrium. Several effects may act at one place.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "model/effects/setting.h"
#include "model/info/model_info.h"

namespace strut {

/// Where in a car an effect may act; bits of a set. On a rig there is one place of each kind.
enum EffectPlaces : unsigned {
  kOnAxle = 1,     // "front", "rear": both corners, unless a corner has a setting of its own
  kOnCorner = 2,   // "front_left", ...
  kOnBody = 4,     // "body"
  kOnRoad = 8,     // "road": the maneuver
  kOnChannel = 16  // the channel a sensor reads
};

struct EffectParameter {
  std::string name, unit, description;  // unit "1" if none
  double neutral;                       // where it is not given
  bool switches;     // the effect vanishes where all that switch are neutral; else a mere shape
  double low, high;  // the plausible range; a value outside of it is an input error
  double typical;    // an ordinary size in a car, where a search begins to look
  unsigned needs = 0, without = 0;  // ModelPart: which the model has all of, and none of
  bool exists_in(const ModelInfo& model) const {
    return (model.parts & needs) == needs && (model.parts & without) == 0;
  }
};

struct EffectInfo {
  std::string name, description, equation, source;
  unsigned places;  // EffectPlaces
  std::vector<EffectParameter> parameters;
};

/// All effects in the order of the documentation.
const std::vector<EffectInfo>& list_effects();

/// Null where no effect has this name.
const EffectInfo* find_effect(std::string_view name);

/// The parameters that exist in this kind of model, in order; none where the effect does not.
std::vector<const EffectParameter*> list_effect_parameters(const EffectInfo& effect,
                                                           const ModelInfo& model);

/// The names of the places where it may act: {""} on a rig; none where the effect does not exist.
std::vector<std::string> list_effect_places(const EffectInfo& effect, const ModelInfo& model);

/// `<place>_<effect>` where the effect has one parameter in this kind of model, else
/// `<place>_<effect>_<parameter>`; without the place on a rig.
std::string make_effect_parameter_name(const EffectInfo& effect, const std::string& place,
                                       const EffectParameter& parameter, const ModelInfo& model);

/// A setting whose every parameter is neutral.
EffectSetting make_neutral_setting(const EffectInfo& effect, const std::string& place,
                                   const ModelInfo& model);

/// Whether the setting leaves the model as it is, bit for bit.
bool is_neutral(const EffectSetting& setting, const ModelInfo& model);

/// Throws ModelError that says what is allowed: unknown effects and places, a setting that is there
/// twice, a wrong number of values, values out of range.
void validate(const EffectSettings& settings, const ModelInfo& model);

/// The value of a parameter at a place; at a corner that has no setting of its own the axle's;
/// neutral where there is none. `parameter` counts list_effect_parameters.
double get_effect_value(const EffectSettings& settings, const EffectInfo& effect,
                        const ModelInfo& model, const std::string& place,
                        std::size_t parameter = 0);

/// Sets it; at an axle for both its corners. What then is as if absent is dropped, so that equal
/// models compare equal.
void set_effect_value(EffectSettings& settings, const EffectInfo& effect, const ModelInfo& model,
                      const std::string& place, std::size_t parameter, double value);

}  // namespace strut
