// A number of a model that is set by name: in files, by `--set name=value`, as an axis of a grid,
// as an unknown of a fit.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "base/text/range.h"

namespace strut {

struct Parameter {
  std::string name;
  std::string unit;                     // "1" if none
  std::optional<double> default_value;  // for files without it; nothing: required
  Range allowed;  // the plausible range; a value outside of it is an input error
  std::string description;
  std::string source;  // for default and range; "" where they need none
  /// Typical magnitude, the scale of a search that starts from 0; 0: half of the range.
  double typical = 0.0;
  bool is_effect = false;
  bool is_maneuver = false;  // belongs to the maneuver's file, not to the vehicle's
  /// Axle or corner of the part that loses this rate as it wears; "": no such part.
  std::string wears_at{};
};

/// A parameter with access to its value in a Subject.
template <class Subject>
struct ParameterOf : Parameter {
  /// For a parameter of an axle the mean of its two corners.
  std::function<double(const Subject&)> get;
  std::function<void(Subject&, double)> set;
};

}  // namespace strut
