// strut study: a table of trainings, from sweeps to a report.
#pragma once

#include <string>
#include <vector>

namespace strut {

int run_study(const std::vector<std::string>& arguments);

}  // namespace strut
