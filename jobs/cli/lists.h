// Lists as one argument: "a,b,c".
#pragma once

#include <string>
#include <vector>

namespace strut {

/// What stands between the commas, without blanks around it.
std::vector<std::string> split_list(const std::string& text);

}  // namespace strut
