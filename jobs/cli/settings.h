// Option values with an inner form: NAME=VALUE and FROM:TO.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/error/input_error.h"
#include "jobs/cli/arguments.h"

namespace strut {

/// Calls `function`; an InputError that it throws gets the prefix "--OPTION: ".
template <class Function>
auto name_option(const std::string& option, const Function& function) {
  try {
    return function();
  } catch (const InputError& e) {
    throw InputError("--" + option + ": " + e.what());
  }
}

/// Reads FROM:TO, two finite times [s]. Throws InputError that names the option.
std::pair<double, double> read_time_range(const Arguments& arguments, const std::string& option);

/// Replaces `values`, one for each of `names`, by those of the settings NAME=VALUE of an option.
/// Throws InputError that names the option where a name is unknown or a value not finite.
void apply_settings(const std::string& option, const std::vector<std::string>& settings,
                    const std::vector<std::string>& names, std::vector<double>& values);

}  // namespace strut
