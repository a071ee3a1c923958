// `strut design`: which snapshot instant, window and sensors identify a sweep's parameters best.
#pragma once

#include <string>
#include <vector>

namespace strut {

/// Returns an exit code. Throws InputError, EnvironmentError.
int run_design(const std::vector<std::string>& arguments);

}  // namespace strut
