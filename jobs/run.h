// `strut run` and `strut resume`.
#pragma once

#include <string>
#include <vector>

namespace strut {

int run_run(const std::vector<std::string>& arguments);
int run_resume(const std::vector<std::string>& arguments);

}  // namespace strut
