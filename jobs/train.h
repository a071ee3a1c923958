// strut train: a network that identifies parameters from a snapshot.
#pragma once

#include <string>
#include <vector>

namespace strut {

int run_train(const std::vector<std::string>& arguments);

}  // namespace strut
