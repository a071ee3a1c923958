// `strut verify`.
#pragma once

#include "jobs/cli/arguments.h"

namespace strut {

Arguments describe_verify();
int run_verify(const Arguments& arguments);

}  // namespace strut
