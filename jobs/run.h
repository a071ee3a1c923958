// `strut run` and `strut resume`.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace strut {

/// Who runs this: program and host, as attributes of every shard.
std::vector<std::pair<std::string, std::string>> make_run_provenance();

int run_run(const std::vector<std::string>& arguments);
int run_resume(const std::vector<std::string>& arguments);

}  // namespace strut
