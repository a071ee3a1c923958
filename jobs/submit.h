// strut submit and strut cancel: a sweep as tasks that run elsewhere.
#pragma once

#include <string>
#include <vector>

namespace strut {

/// The commands; exit code. Throws InputError, EnvironmentError.
int run_submit(const std::vector<std::string>& arguments);
int run_cancel(const std::vector<std::string>& arguments);

}  // namespace strut
