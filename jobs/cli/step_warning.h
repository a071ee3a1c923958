// The warning about steps that are too long for a model's effects.
#pragma once

#include <string>

namespace strut {

/// Prints a note if `step` [s], set as `name` ("--step"), exceeds the `longest` one that resolves
/// the effects of `model` (model/longest_step.h). Returns whether it does.
bool warn_of_long_step(const std::string& name, double step, const std::string& model,
                       double longest);

}  // namespace strut
