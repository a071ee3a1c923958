// An effect of the catalogue (catalogue.h) in a model.
#pragma once

#include <string>
#include <vector>

namespace strut {

struct EffectSetting {
  std::string effect;          // name in the catalogue (names.h)
  std::string place;           // "rear", "front_left", "body", "road", a channel; "" on a rig
  std::vector<double> values;  // in the order of list_effect_parameters
  bool operator==(const EffectSetting&) const = default;
};

using EffectSettings = std::vector<EffectSetting>;

}  // namespace strut
