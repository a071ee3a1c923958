// `strut diagnose`: what the simulation gets wrong, why, and what mending it gains.
#pragma once

#include <string>
#include <vector>

namespace strut {

/// Takes the arguments after the command's name, returns an exit code. Throws InputError,
/// EnvironmentError.
int run_diagnose(const std::vector<std::string>& arguments);

}  // namespace strut
