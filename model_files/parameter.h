// A number of a model that people set by name: in files, `--set name=value`, as an axis of a grid,
// as an unknown of a fit.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/text/range.h"

namespace strut {

struct Parameter {
  std::string name;
  std::string unit;                     // "1" if none
  std::optional<double> default_value;  // where a file does not give it; nothing: it must
  Range allowed;  // the plausible range; a value outside of it is an input error
  std::string description;
  std::string source;    // of default and range; "" where they need none
  double typical = 0.0;  // of an effect: an ordinary size, the scale of a search from 0; else 0
  bool is_effect = false;
  bool is_maneuver = false;  // of the maneuver's file, not of the vehicle's
};

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
