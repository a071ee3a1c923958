#include "model_files/parameter.h"

#include <fmt/format.h>

#include "base/error/input_error.h"
#include "base/text/format_number.h"
#include "base/text/nearest_name.h"

namespace strut {

void refuse_parameter(const std::string& name, const std::vector<const Parameter*>& known) {
  std::vector<std::string> names, plain;
  for (const Parameter* parameter : known) {
    names.push_back(parameter->name);
    if (!parameter->is_effect) plain.push_back(parameter->name);
  }
  const std::string suggestion = suggest_name(name, names);
  if (!suggestion.empty())
    throw InputError(fmt::format("unknown parameter '{}'{}", name, suggestion));
  throw InputError(
      fmt::format("unknown parameter '{}'; known: {}, and those of effects, docs/effects.md", name,
                  join_names(plain)));
}

void check_value(const Parameter& parameter, double value) {
  if (parameter.allowed.contains(value)) return;
  throw InputError(fmt::format("{} = {}: {}", parameter.name, format_number(value),
                               parameter.allowed.describe()));
}

}  // namespace strut
