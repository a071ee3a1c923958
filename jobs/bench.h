// `strut bench`: throughput and accuracy of this machine.
#pragma once

#include <string>
#include <vector>

namespace strut {

/// Exit code of the command; see its --help.
int run_bench(const std::vector<std::string>& arguments);

}  // namespace strut
