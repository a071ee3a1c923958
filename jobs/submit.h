// strut submit: a sweep as tasks that run elsewhere.
#pragma once

#include <string>
#include <vector>

namespace strut {

/// The command; exit code. Throws InputError, EnvironmentError.
int run_submit(const std::vector<std::string>& arguments);

}  // namespace strut
