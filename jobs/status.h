// `strut status`.
#pragma once

#include <string>
#include <vector>

namespace strut {

int run_status(const std::vector<std::string>& arguments);

}  // namespace strut
