#include "model/effects/catalogue.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/error/check.h"
#include "base/names/corners.h"
#include "base/text/nearest_name.h"
#include "model/effects/tables.h"
#include "model/error/model_error.h"

namespace strut {
namespace {

std::vector<EffectInfo> make_effects() {
  std::vector<EffectInfo> effects = make_strut_effects();
  for (EffectInfo& effect : make_body_effects()) effects.push_back(std::move(effect));
  for (EffectInfo& effect : make_sensor_effects()) effects.push_back(std::move(effect));
  return effects;
}

/// "rear" for "rear_left" and "rear_right", "" where `place` is not a corner.
std::string find_axle_of(const std::string& place) {
  const int corner = find_corner(place);
  return corner < 0 ? "" : kAxleNames[static_cast<std::size_t>(axle_of(corner))];
}

template <class Settings>
auto find_setting(Settings& settings, const std::string& effect, const std::string& place) {
  return std::find_if(settings.begin(), settings.end(), [&](const EffectSetting& s) {
    return s.effect == effect && s.place == place;
  });
}

std::vector<double> get_values(const EffectSettings& settings, const EffectInfo& effect,
                               const ModelInfo& model, const std::string& place) {
  auto found = find_setting(settings, effect.name, place);
  if (found != settings.end()) return found->values;
  const std::string axle = find_axle_of(place);
  if (!axle.empty()) return get_values(settings, effect, model, axle);
  return make_neutral_setting(effect, place, model).values;
}

/// Replaces the setting at a place, or removes it where the same values hold without it.
void put_values(EffectSettings& settings, const EffectInfo& effect, const ModelInfo& model,
                const std::string& place, const std::vector<double>& values) {
  const auto found = find_setting(settings, effect.name, place);
  const auto at = found - settings.begin();
  EffectSettings others = settings;  // without the one at this place
  if (found != settings.end()) others.erase(others.begin() + at);
  if (get_values(others, effect, model, place) == values) {
    settings = std::move(others);
  } else if (found != settings.end()) {
    found->values = values;
  } else {
    settings.push_back({effect.name, place, values});
  }
}

/// The channels that a sensor may read.
std::vector<std::string> list_sensor_channels(const ModelInfo& model) {
  std::vector<std::string> names;
  names.reserve(model.channels.size());
  for (const ChannelInfo& channel : model.channels) {
    if (channel.name != "time") names.push_back(channel.name);
  }
  return names;
}

std::string describe(const EffectSetting& setting) {
  return "effect " + setting.effect + (setting.place.empty() ? "" : " at " + setting.place);
}

const EffectInfo& get_effect(const std::string& name) {
  const EffectInfo* effect = find_effect(name);
  STRUT_CHECK(effect != nullptr, fmt::format("effect {} is not in the catalogue", name));
  return *effect;
}

void check_values(const EffectSetting& setting,
                  const std::vector<const EffectParameter*>& parameters) {
  if (setting.values.size() != parameters.size()) {
    throw ModelError(fmt::format("{}: has {} values; allowed: {}", describe(setting),
                                 setting.values.size(), parameters.size()));
  }
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const EffectParameter& p = *parameters[i];
    if (setting.values[i] >= p.low && setting.values[i] <= p.high) continue;
    throw ModelError(fmt::format("{}: {} = {:g}: must lie in [{:g}, {:g}] {}", describe(setting),
                                 p.name, setting.values[i], p.low, p.high, p.unit));
  }
}

void check_setting(const EffectSetting& setting, const ModelInfo& model) {
  const EffectInfo* effect = find_effect(setting.effect);
  if (effect == nullptr) {
    throw ModelError(
        fmt::format("effect {}: unknown; `strut list effects` lists all", setting.effect));
  }
  const std::vector<std::string> places = list_effect_places(*effect, model);
  if (places.empty()) {
    throw ModelError(fmt::format("effect {}: does not exist in a {}", setting.effect, model.name));
  }
  if (std::find(places.begin(), places.end(), setting.place) == places.end()) {
    throw ModelError(
        fmt::format("{}: place must be one of {}", describe(setting), join_names(places)));
  }
  check_values(setting, list_effect_parameters(*effect, model));
}

}  // namespace

const std::vector<EffectInfo>& list_effects() {
  static const std::vector<EffectInfo> effects = make_effects();
  return effects;
}

const EffectInfo* find_effect(std::string_view name) {
  for (const EffectInfo& effect : list_effects()) {
    if (effect.name == name) return &effect;
  }
  return nullptr;
}

std::vector<const EffectParameter*> list_effect_parameters(const EffectInfo& effect,
                                                           const ModelInfo& model) {
  std::vector<const EffectParameter*> list;
  list.reserve(effect.parameters.size());
  for (const EffectParameter& p : effect.parameters) {
    if (p.exists_in(model)) list.push_back(&p);
  }
  return list;
}

std::string make_effect_parameter_name(const EffectInfo& effect, const std::string& place,
                                       const EffectParameter& parameter, const ModelInfo& model) {
  const bool is_single = list_effect_parameters(effect, model).size() == 1;
  return (place.empty() ? "" : place + "_") + effect.name + (is_single ? "" : "_" + parameter.name);
}

std::vector<std::string> list_effect_places(const EffectInfo& effect, const ModelInfo& model) {
  if (list_effect_parameters(effect, model).empty()) return {};
  if ((effect.places & kOnChannel) != 0) return list_sensor_channels(model);
  if (!model.has(kHasCar)) return {PlaceName::kRig};
  std::vector<std::string> places;
  if ((effect.places & kOnAxle) != 0) {
    places.insert(places.end(), kAxleNames.begin(), kAxleNames.end());
  }
  if ((effect.places & kOnCorner) != 0) {
    places.insert(places.end(), kCornerNames.begin(), kCornerNames.end());
  }
  if ((effect.places & kOnBody) != 0) places.emplace_back(PlaceName::kBody);
  if ((effect.places & kOnRoad) != 0) places.emplace_back(PlaceName::kRoad);
  return places;
}

EffectSetting make_neutral_setting(const EffectInfo& effect, const std::string& place,
                                   const ModelInfo& model) {
  EffectSetting setting{effect.name, place, {}};
  for (const EffectParameter* p : list_effect_parameters(effect, model)) {
    setting.values.push_back(p->neutral);
  }
  return setting;
}

bool is_neutral(const EffectSetting& setting, const ModelInfo& model) {
  const auto parameters = list_effect_parameters(get_effect(setting.effect), model);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (parameters[i]->switches && setting.values[i] != parameters[i]->neutral) return false;
  }
  return true;
}

void validate(const EffectSettings& settings, const ModelInfo& model) {
  for (const EffectSetting& setting : settings) {
    check_setting(setting, model);
    const auto same = [&](const EffectSetting& other) {
      return other.effect == setting.effect && other.place == setting.place;
    };
    if (std::count_if(settings.begin(), settings.end(), same) > 1) {
      throw ModelError(describe(setting) + ": given twice; allowed: once");
    }
  }
}

double get_effect_value(const EffectSettings& settings, const EffectInfo& effect,
                        const ModelInfo& model, const std::string& place, std::size_t parameter) {
  std::vector<double> at_corners;  // corners of the axle with settings of their own
  for (const char* corner : kCornerNames) {
    if (find_axle_of(corner) != place) continue;
    if (find_setting(settings, effect.name, corner) == settings.end()) continue;
    at_corners.push_back(get_values(settings, effect, model, corner).at(parameter));
  }
  const double own = get_values(settings, effect, model, place).at(parameter);
  if (at_corners.empty()) return own;
  return 0.5 * (at_corners.front() + (at_corners.size() > 1 ? at_corners.back() : own));
}

void set_effect_value(EffectSettings& settings, const EffectInfo& effect, const ModelInfo& model,
                      const std::string& place, std::size_t parameter, double value) {
  const auto put = [&](const std::string& where) {
    std::vector<double> values = get_values(settings, effect, model, where);
    values.at(parameter) = value;
    put_values(settings, effect, model, where, values);
  };
  // Collected before the axle is set: afterwards their settings are redundant and are removed.
  std::vector<std::string> corners;
  for (const char* corner : kCornerNames) {
    if (find_axle_of(corner) != place) continue;
    if (find_setting(settings, effect.name, corner) != settings.end()) corners.push_back(corner);
  }
  put(place);
  for (const std::string& corner : corners) put(corner);
}

}  // namespace strut
