// strut export: a trained network for other programs.
#pragma once

#include <string>
#include <vector>

namespace strut {

int run_export(const std::vector<std::string>& words);

}  // namespace strut
