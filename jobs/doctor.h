// strut doctor: can a file system, a scheduler and its processors keep what a sweep promises?
#pragma once

#include <string>
#include <vector>

namespace strut {

/// The command; exit code. Throws InputError, EnvironmentError.
int run_doctor(const std::vector<std::string>& arguments);

}  // namespace strut
