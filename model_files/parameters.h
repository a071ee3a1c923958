// Every parameter of a car and a maneuver that can be set by name: on the command line
// (`--set name=value`), as an axis of a grid, as a quantity to identify. Listed once; readers,
// help texts and documentation derive from the list.
//
// Names: `front_` and `rear_` are both corners of an axle, `front_left_` ... one corner. Parameters
// of effects: docs/effects.md.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/error/input_error.h"
#include "model/car/case.h"
#include "model_files/parameter.h"

namespace strut {

/// Defaults are those of examples/vehicles/paper_sedan.toml and examples/maneuvers/bump_20mps.toml.
using ParameterInfo = ParameterOf<Case>;

/// All parameters in a fixed order: whole car, axles, corners, tire, maneuver, effects.
const std::vector<ParameterInfo>& list_parameters();

/// All parameters except those of effects that have their default.
std::vector<const ParameterInfo*> list_parameters_in_use(const Case& c);

/// Throws InputError with the nearest known name.
const ParameterInfo& find_parameter(const std::string& name);

double get_parameter(const Case& c, const std::string& name);

/// Throws InputError with name, value and allowed range.
void set_parameter(Case& c, const std::string& name, double value);

/// A number as it was given: "speed=36km/h".
struct NamedValue {
  std::string name;
  double value = 0.0;
  std::string unit = {};  // behind the number; empty: SI

  /// The value in the SI unit `si`; empty: of a quantity whose unit is not known here. Throws
  /// InputError for a unit of something else.
  double to_si(const std::string& si) const;
};

/// Takes "name=value" or "name=value unit" apart. Throws InputError where the text has another
/// form.
NamedValue parse_setting(const std::string& setting);

/// Applies "name=value", in the parameter's unit or the one given. Throws InputError as
/// parse_setting and set_parameter.
void apply_setting(Case& c, const std::string& setting);

}  // namespace strut
