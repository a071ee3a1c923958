// Parameters by their names: what is refused, and how that is said.
#pragma once

#include <string>
#include <vector>

#include "model/info/parameter.h"

namespace strut {

/// Throws InputError for a name that is none of `known`, with the nearest one; where none is near
/// with all that are not of effects.
[[noreturn]] void refuse_parameter(const std::string& name,
                                   const std::vector<const Parameter*>& known);

/// Throws InputError with name, value and allowed range where the value is outside of it.
void check_value(const Parameter& parameter, double value);

/// The parameter of a table by its name. Throws as refuse_parameter.
template <class Listed>
const Listed& find_listed(const std::vector<Listed>& table, const std::string& name) {
  std::vector<const Parameter*> known;
  known.reserve(table.size());
  for (const Listed& parameter : table) {
    if (parameter.name == name) return parameter;
    known.push_back(&parameter);
  }
  refuse_parameter(name, known);
}

}  // namespace strut
