// Access to parameters by name, with errors for unknown names and invalid values.
#pragma once

#include <string>
#include <vector>

#include "model/info/parameter.h"

namespace strut {

/// Throws InputError for an unknown name, with the nearest known one; where none is near, with all
/// parameters except those of effects.
[[noreturn]] void refuse_parameter(const std::string& name,
                                   const std::vector<const Parameter*>& known);

/// Throws InputError with name, value and allowed range where the value is out of range.
void check_value(const Parameter& parameter, double value);

/// The parameter of this name in a table. Throws as refuse_parameter.
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
