// strut identify: parameters from measurements.
#pragma once

#include <string>
#include <vector>

namespace strut {

int run_identify(const std::vector<std::string>& words);

}  // namespace strut
