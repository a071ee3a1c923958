// strut cancel: ends what `strut submit` began.
#pragma once

#include <string>
#include <vector>

namespace strut {

/// The command; exit code. Throws InputError, EnvironmentError.
int run_cancel(const std::vector<std::string>& arguments);

}  // namespace strut
