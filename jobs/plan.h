// strut plan: from a sweep file to a sweep folder.
#pragma once

#include <string>
#include <vector>

namespace strut {

int run_plan(const std::vector<std::string>& arguments);

}  // namespace strut
