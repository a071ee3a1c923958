// Lists as one argument: "a,b,c".
#pragma once

#include <string>
#include <vector>

namespace strut {

/// Returns the parts between the commas, without surrounding blanks.
std::vector<std::string> split_list(const std::string& text);

}  // namespace strut
