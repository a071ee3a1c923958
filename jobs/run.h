// `strut run` and `strut resume`.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "jobs/cli/arguments.h"

namespace strut {

/// Who runs this: program and host, as attributes of every shard.
std::vector<std::pair<std::string, std::string>> make_run_provenance();

Arguments describe_run();
int run_run(const Arguments& arguments);
Arguments describe_resume();
int run_resume(const Arguments& arguments);

}  // namespace strut
