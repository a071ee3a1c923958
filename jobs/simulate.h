// `strut simulate`: one run, all channels over time; or the suspension's kinematics.
#pragma once

#include <string>
#include <vector>

namespace strut {

/// Exit code of the command; see its --help.
int run_simulate(const std::vector<std::string>& arguments);

}  // namespace strut
