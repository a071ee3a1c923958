// `strut compare`: measured against simulated, channel by channel.
#pragma once

#include <string>
#include <vector>

namespace strut {

/// Takes the arguments after the command's name, returns an exit code. Throws InputError,
/// EnvironmentError.
int run_compare(const std::vector<std::string>& arguments);

}  // namespace strut
