// `strut verify`.
#pragma once

#include <string>
#include <vector>

namespace strut {

int run_verify(const std::vector<std::string>& arguments);

}  // namespace strut
