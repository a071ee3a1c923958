#include "model_files/read_effects.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/text/format_number.h"
#include "model_files/drop_tables.h"

namespace strut {
namespace {

std::vector<std::string> list_effect_names(const ModelInfo& model) {
  std::vector<std::string> names;
  for (const EffectInfo& effect : list_effects()) {
    if (!list_effect_places(effect, model).empty()) names.push_back(effect.name);
  }
  return names;
}

const EffectInfo& read_name(const Table& table, const ModelInfo& model) {
  const EffectInfo* effect = find_effect(table.text("name"));
  if (effect != nullptr && list_effect_places(*effect, model).empty()) {
    throw table.error("name", fmt::format("a {} does not have this effect", model.name));
  }
  if (effect != nullptr) return *effect;
  const std::vector<std::string> names = list_effect_names(model);
  return *find_effect(names[static_cast<std::size_t>(table.choice("name", names))]);
}

EffectSetting read_effect(const Table& table, const ModelInfo& model) {
  const EffectInfo& effect = read_name(table, model);
  const std::vector<std::string> places = list_effect_places(effect, model);
  const bool has_place = !(places.size() == 1 && places.front().empty());
  EffectSetting setting{effect.name, "", {}};
  if (has_place) setting.place = places[static_cast<std::size_t>(table.choice("place", places))];
  for (const EffectParameter* p : list_effect_parameters(effect, model)) {
    const Range allowed = get_range(*p);
    const bool needed = p->switches && list_effect_parameters(effect, model).size() == 1;
    setting.values.push_back(needed ? table.number(p->name, allowed)
                                    : table.number_or(p->name, p->neutral, allowed));
  }
  return setting;
}

std::string write_effect(const EffectSetting& setting, const ModelInfo& model) {
  std::string text = fmt::format("[[effect]]\nname = \"{}\"\n", setting.effect);
  if (!setting.place.empty()) text += fmt::format("place = \"{}\"\n", setting.place);
  const auto parameters = list_effect_parameters(*find_effect(setting.effect), model);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    text += fmt::format("{} = {}\n", parameters[i]->name, format_number(setting.values[i]));
  }
  return text;
}

}  // namespace

Range get_range(const EffectParameter& parameter) {
  return between(parameter.low, parameter.high, parameter.unit == "1" ? "" : parameter.unit);
}

Parameter make_effect_parameter(const EffectInfo& effect, const std::string& place,
                                const EffectParameter& parameter, const ModelInfo& model) {
  Parameter p;
  p.name = make_effect_parameter_name(effect, place, parameter, model);
  p.unit = parameter.unit;
  p.default_value = parameter.neutral;
  p.allowed = get_range(parameter);
  p.description =
      parameter.description + "; effect " + effect.name + (place.empty() ? "" : ", " + place);
  p.source = effect.source;
  p.typical = parameter.typical;
  p.is_effect = true;
  return p;
}

EffectSettings read_effects(const Table& root, const ModelInfo& model) {
  EffectSettings settings;
  if (!root.has("effect")) return settings;
  for (const Table& table : root.tables("effect")) {
    settings.push_back(read_effect(table, model));
    const EffectSetting& last = settings.back();
    const auto same = [&](const EffectSetting& s) {
      return s.effect == last.effect && s.place == last.place;
    };
    if (std::count_if(settings.begin(), settings.end(), same) > 1) {
      const std::string where = last.place.empty() ? "" : fmt::format(" at \"{}\"", last.place);
      throw table.error("name", fmt::format("given twice{}; allowed: once", where));
    }
  }
  return settings;
}

std::string replace_effects(const std::string& text, const EffectSettings& settings,
                            const ModelInfo& model) {
  std::string changed = drop_tables(text, "effect");
  if (!changed.empty() && changed.back() != '\n' && !settings.empty()) changed += '\n';
  for (const EffectSetting& setting : settings) {
    changed += (changed.empty() ? "" : "\n") + write_effect(setting, model);
  }
  return changed;
}

}  // namespace strut
