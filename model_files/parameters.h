// Every parameter of a car and a maneuver that can be set by name: on the command line
// (`--set name=value`), as an axis of a grid, as a quantity to identify. Listed once; readers,
// help texts and documentation derive from the list.
//
// Names: `front_` and `rear_` are both corners of an axle, `front_left_` ... one corner. Parameters
// of effects: docs/effects.md.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "io/format/config.h"
#include "model/car/case.h"

namespace strut {

struct ParameterInfo {
  std::string name;
  std::string unit;            // "1" if none
  double default_value = 0.0;  // of examples/vehicles/paper_sedan.toml, maneuvers/bump_20mps.toml
  Range allowed;               // the plausible range; a value outside of it is an input error
  std::string description;
  std::string source;  // of the default value
  /// A parameter of an axle reads as the mean of its two corners.
  std::function<double(const Case&)> get;
  std::function<void(Case&, double)> set;
  /// Of an effect of the catalogue: an ordinary size, the scale of a search from 0; else 0.
  double typical = 0.0;
  bool is_effect = false;
};

/// All parameters in a fixed order: whole car, axles, corners, tire, maneuver, effects.
const std::vector<ParameterInfo>& list_parameters();

/// Every parameter that is not of an effect, and those of effects that are not at their default.
std::vector<const ParameterInfo*> list_parameters_in_use(const Case& c);

/// Throws InputError with the nearest known name.
const ParameterInfo& find_parameter(const std::string& name);

double get_parameter(const Case& c, const std::string& name);

/// Throws InputError with name, value and allowed range.
void set_parameter(Case& c, const std::string& name, double value);

/// Name and value of "name=value". Throws InputError where the text is not that.
std::pair<std::string, double> parse_setting(const std::string& setting);

/// Applies "name=value". Throws InputError where the text is not that.
void apply_setting(Case& c, const std::string& setting);

}  // namespace strut
