// A number of a model that people set by name: in files, `--set name=value`, as an axis of a grid,
// as an unknown of a fit.
#pragma once

#include <optional>
#include <string>

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

}  // namespace strut
