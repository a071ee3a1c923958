// A number of a model that people set by name: in files, `--set name=value`, as an axis of a grid,
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
  std::optional<double> default_value;  // where a file does not give it; nothing: it must
  Range allowed;  // the plausible range; a value outside of it is an input error
  std::string description;
  std::string source;  // of default and range; "" where they need none
  /// An ordinary size, the scale of a search that starts from 0; 0: half of the range.
  double typical = 0.0;
  bool is_effect = false;
  bool is_maneuver = false;  // of the maneuver's file, not of the vehicle's
};

/// A parameter, and where it is kept in what it is a parameter of.
template <class Subject>
struct ParameterOf : Parameter {
  /// A parameter of an axle reads as the mean of its two corners.
  std::function<double(const Subject&)> get;
  std::function<void(Subject&, double)> set;
};

}  // namespace strut
