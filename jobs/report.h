// strut report: one HTML file about a folder of ours.
#pragma once

#include <string>
#include <vector>

namespace strut {

int run_report(const std::vector<std::string>& arguments);

}  // namespace strut
