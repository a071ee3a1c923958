// `strut verify`.
#pragma once

#include "jobs/arguments.h"

namespace strut {

Arguments describe_verify();
int run_verify(const Arguments& arguments);

}  // namespace strut
