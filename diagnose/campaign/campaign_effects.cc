#include "diagnose/campaign/campaign_effects.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/text/nearest_name.h"
#include "model/effects/catalogue.h"
#include "model/effects/names.h"

namespace strut {
namespace {

constexpr char kExclude[] = "exclude", kOn[] = "on";
constexpr std::string_view kAt = " at ";

std::vector<std::string> list_names(const ModelInfo& model) {
  std::vector<std::string> names;
  for (const EffectInfo& effect : list_effects()) {
    if (!list_effect_places(effect, model).empty()) names.push_back(effect.name);
  }
  return names;
}

/// One entry; without a place it stands for all of them.
void read_entry(const Table& table, const char* key, const std::string& entry,
                const ModelInfo& model, std::vector<EffectAtPlace>& list) {
  const std::size_t at = entry.find(kAt);
  const std::string name = entry.substr(0, at);
  const EffectInfo* effect = find_effect(name);
  const std::vector<std::string> places =
      effect == nullptr ? std::vector<std::string>{} : list_effect_places(*effect, model);
  if (places.empty()) {
    const std::vector<std::string> names = list_names(model);
    throw table.error(key, fmt::format("'{}' is not an effect of a {}; effects: {}{}", name,
                                       model.name, join_names(names), suggest_name(name, names)));
  }
  if (name == EffectName::kSensorBias) {
    throw table.error(key, name + " is an unknown of every run and channel; it is no hypothesis");
  }
  if (at == std::string::npos) {
    for (const std::string& place : places) list.push_back({name, place});
    return;
  }
  const std::string place = entry.substr(at + kAt.size());
  if (std::find(places.begin(), places.end(), place) == places.end()) {
    throw table.error(key, fmt::format("{}: '{}' is not a place of it; places: {}{}", name, place,
                                       places.front().empty() ? "none, a rig has one of each"
                                                              : join_names(places),
                                       suggest_name(place, places)));
  }
  list.push_back({name, place});
}

std::vector<EffectAtPlace> read_list(const Table& table, const char* key, const ModelInfo& model) {
  std::vector<EffectAtPlace> list;
  if (!table.has(key)) return list;
  for (const std::string& entry : table.texts(key)) read_entry(table, key, entry, model, list);
  return list;
}

/// A corner's parameters cannot be free beside those of its axle.
void check_on(const Table& table, const std::vector<EffectAtPlace>& on) {
  for (std::size_t i = 0; i < on.size(); ++i) {
    for (std::size_t k = 0; k < on.size(); ++k) {
      const bool overlap =
          i != k && on[i].effect == on[k].effect && on[k].place.starts_with(on[i].place);
      if (!overlap) continue;
      throw table.error(kOn, fmt::format("{0} at {1} and at {2} overlap; give one place, as in "
                                         "\"{0} at {1}\"",
                                         on[i].effect, on[i].place, on[k].place));
    }
  }
}

}  // namespace

CampaignEffects read_campaign_effects(const Table& root, const ModelInfo& model) {
  CampaignEffects effects;
  const auto table = root.find_table("effects");
  if (!table) return effects;
  effects.exclude = read_list(*table, kExclude, model);
  effects.on = read_list(*table, kOn, model);
  check_on(*table, effects.on);
  for (const EffectAtPlace& e : effects.on) {
    if (!contains(effects.exclude, e.effect, e.place)) continue;
    throw table->error(kOn,
                       fmt::format("'{}' is also in exclude; must be in one of the two", e.effect));
  }
  return effects;
}

bool contains(const std::vector<EffectAtPlace>& list, const std::string& effect,
              const std::string& place) {
  return std::any_of(list.begin(), list.end(), [&](const EffectAtPlace& e) {
    return e.effect == effect && e.place == place;
  });
}

std::vector<std::string> list_parameter_names(const EffectAtPlace& effect, const ModelInfo& model) {
  const EffectInfo& info = *find_effect(effect.effect);
  std::vector<std::string> names;
  for (const EffectParameter* p : list_effect_parameters(info, model)) {
    names.push_back(make_effect_parameter_name(info, effect.place, *p, model));
  }
  return names;
}

void switch_on(const std::vector<EffectAtPlace>& effects, Model& model) {
  for (const EffectAtPlace& e : effects) {
    const EffectInfo& info = *find_effect(e.effect);
    const auto parameters = list_effect_parameters(info, model.info());
    const auto is_on = [&](const EffectSetting& s) {
      return s.effect == e.effect && s.place == e.place && !is_neutral(s, model.info());
    };
    const EffectSettings& settings = std::as_const(model).effects();
    if (std::any_of(settings.begin(), settings.end(), is_on)) continue;
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      const double start = parameters[i]->calc_start();
      set_effect_value(model.effects(), info, model.info(), e.place, i, start);
    }
  }
}

}  // namespace strut
