// strut cancel: ends what `strut submit` began.
#pragma once

#include "jobs/cli/arguments.h"

namespace strut {

Arguments describe_cancel();
int run_cancel(const Arguments& arguments);

}  // namespace strut
