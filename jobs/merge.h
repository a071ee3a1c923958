// strut merge: one file of all shards.
#pragma once

#include <string>
#include <vector>

namespace strut {

int run_merge(const std::vector<std::string>& arguments);

}  // namespace strut
