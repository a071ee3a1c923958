#include "jobs/list.h"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>

#include "base/text/format_number.h"
#include "base/text/nearest_name.h"
#include "base/text/range.h"
#include "io/format/json.h"
#include "jobs/cli/command.h"
#include "jobs/cli/messages.h"
#include "model/effects/catalogue.h"
#include "model_files/model_tables.h"

namespace strut {
namespace {

const std::vector<std::string> kTopics = {"parameters", "channels", "effects", "commands"};

/// Prints rows of text in aligned columns, the header first; the last column is not padded.
void print_columns(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const auto& row : rows) {
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
  }
  for (const auto& row : rows) {
    for (std::size_t c = 0; c + 1 < row.size(); ++c) {
      std::cout << fmt::format("{:<{}}", row[c], widths[c] + 2);
    }
    std::cout << row.back() << "\n";
  }
}

std::string format_bounds(const Range& range) {
  return fmt::format("{}{}, {}]", range.open_low ? "(" : "[", format_number(range.low),
                     format_number(range.high));
}

std::string format_optional(const std::optional<double>& value) {
  return value ? format_number(*value) : "-";
}

Json make_json(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

Json make_json(const Range& range) {
  Json bounds = Json::array();
  bounds.push_back(range.low);
  bounds.push_back(range.high);
  return bounds;
}

// --- parameters ------------------------------------------------------------------------------

void print_parameters(const ModelTables& model) {
  const bool has_values =
      std::any_of(model.parameters.begin(), model.parameters.end(),
                  [](const ListedParameter& listed) { return listed.value.has_value(); });
  std::vector<std::vector<std::string>> rows = {{"NAME", "UNIT", "DEFAULT"}};
  if (has_values) rows.front().push_back("VALUE");
  rows.front().insert(rows.front().end(), {"ALLOWED", "MEANING"});
  for (const ListedParameter& listed : model.parameters) {
    const Parameter& p = *listed.parameter;
    std::vector<std::string> row = {p.name, p.unit, format_optional(p.default_value)};
    if (has_values) row.push_back(format_optional(listed.value));
    row.insert(row.end(), {format_bounds(p.allowed), p.description});
    rows.push_back(std::move(row));
  }
  print_columns(rows);
}

Json make_parameters_json(const ModelTables& model) {
  Json list = Json::array();
  for (const ListedParameter& listed : model.parameters) {
    const Parameter& p = *listed.parameter;
    Json json = Json::object();
    json["name"] = p.name;
    json["unit"] = p.unit;
    json["default"] = make_json(p.default_value);
    json["value"] = make_json(listed.value);
    json["range"] = make_json(p.allowed);
    json["effect"] = p.is_effect;
    json["source"] = p.source;
    json["meaning"] = p.description;
    list.push_back(json);
  }
  return list;
}

// --- channels --------------------------------------------------------------------------------

void print_channels(const ModelTables& model) {
  std::vector<std::vector<std::string>> rows = {{"NAME", "UNIT", "MEANING"}};
  for (const ChannelInfo& c : model.model->channels)
    rows.push_back({c.name, c.unit, c.description});
  for (const InputInfo& i : model.model->inputs) {
    rows.push_back(
        {i.name, i.unit, fmt::format("{}input: {}", i.required ? "" : "optional ", i.description)});
  }
  print_columns(rows);
}

Json make_channels_json(const ModelTables& model) {
  Json list = Json::array();
  const auto add = [&](const std::string& name, const std::string& unit, const std::string& meaning,
                       const char* role) {
    Json json = Json::object();
    json["name"] = name;
    json["unit"] = unit;
    json["role"] = role;
    json["meaning"] = meaning;
    list.push_back(json);
  };
  for (const ChannelInfo& c : model.model->channels) add(c.name, c.unit, c.description, "output");
  for (const InputInfo& i : model.model->inputs) add(i.name, i.unit, i.description, "input");
  return list;
}

// --- effects ---------------------------------------------------------------------------------

/// The effects that have a parameter in this kind of model.
std::vector<const EffectInfo*> list_effects_of(const ModelInfo& model) {
  std::vector<const EffectInfo*> effects;
  for (const EffectInfo& effect : list_effects()) {
    if (!list_effect_parameters(effect, model).empty()) effects.push_back(&effect);
  }
  return effects;
}

void print_effects(const ModelInfo& model) {
  for (const EffectInfo* effect : list_effects_of(model)) {
    std::cout << fmt::format("{}: {}\n    {}\n    source: {}\n", effect->name, effect->description,
                             effect->equation, effect->source);
    for (const EffectParameter* p : list_effect_parameters(*effect, model)) {
      std::cout << fmt::format("    {} [{}] = {}, in {}: {}\n", p->name, p->unit,
                               format_number(p->neutral), format_bounds(between(p->low, p->high)),
                               p->description);
    }
  }
}

Json make_effects_json(const ModelInfo& model) {
  Json list = Json::array();
  for (const EffectInfo* effect : list_effects_of(model)) {
    Json parameters = Json::array();
    for (const EffectParameter* p : list_effect_parameters(*effect, model)) {
      Json json = Json::object();
      json["name"] = p->name;
      json["unit"] = p->unit;
      json["default"] = p->neutral;
      json["range"] = make_json(between(p->low, p->high));
      json["meaning"] = p->description;
      parameters.push_back(json);
    }
    Json json = Json::object();
    json["name"] = effect->name;
    json["places"] = Json(list_effect_places(*effect, model));
    json["parameters"] = parameters;
    json["equation"] = effect->equation;
    json["source"] = effect->source;
    json["meaning"] = effect->description;
    list.push_back(json);
  }
  return list;
}

// --- commands --------------------------------------------------------------------------------

void print_commands(const CommandTable& commands) {
  std::vector<std::vector<std::string>> rows = {{"NAME", "MEANING"}};
  for (const Command& command : commands) rows.push_back({command.name, command.purpose});
  print_columns(rows);
}

Json make_commands_json(const CommandTable& commands) {
  Json list = Json::array();
  for (const Command& command : commands) {
    Json json = Json::object();
    json["name"] = command.name;
    json["meaning"] = command.purpose;
    list.push_back(json);
  }
  return list;
}

}  // namespace

Arguments describe_list() {
  Arguments arguments(
      "strut list TOPIC [MODEL] [OPTIONS]",
      "Lists the parameters of a model (for --set, the axes of a sweep, the unknowns of a fit), "
      "its\n"
      "channels (for snapshots, histories, measured columns) or its effects, or the commands of "
      "this\n"
      "program. MODEL: the file of a vehicle or rig, whose values are then listed, or a kind of\n"
      "model; default: full_vehicle.",
      "  strut list parameters\n"
      "  strut list channels quarter_car --json");
  arguments.add_operand(ArgumentValue::one_of("TOPIC", kTopics));
  arguments.add_operand(ArgumentValue::file("MODEL", {"toml"}));
  arguments.add_switch("json", "print JSON");
  return arguments;
}

int run_list(const Arguments& arguments, const CommandTable& commands) {
  const std::vector<std::string>& words = arguments.positional();
  const auto topic =
      words.empty() ? kTopics.end() : std::find(kTopics.begin(), kTopics.end(), words.front());
  if (topic == kTopics.end() || words.size() > 2) {
    throw arguments.usage_error(
        fmt::format("expected one of {}, and at most one model", join_names(kTopics)));
  }
  if (words.size() > 1 && *topic == "commands") {
    throw arguments.usage_error("the list of commands takes no model");
  }
  const ModelTables model = make_model_tables(words.size() > 1 ? words[1] : "full_vehicle");
  const bool as_json = arguments.is_on("json");
  const auto print = [&](const Json& json, const auto& print_text) {
    if (as_json) {
      std::cout << format_json(json) << "\n";
    } else {
      print_text();
    }
  };
  if (*topic == "parameters") print(make_parameters_json(model), [&] { print_parameters(model); });
  if (*topic == "channels") print(make_channels_json(model), [&] { print_channels(model); });
  if (*topic == "effects") {
    print(make_effects_json(*model.model), [&] { print_effects(*model.model); });
  }
  if (*topic == "commands") print(make_commands_json(commands), [&] { print_commands(commands); });
  return kExitDone;
}

}  // namespace strut
