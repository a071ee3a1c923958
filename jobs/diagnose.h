// `strut diagnose`: finds the errors of a model, their cause, and the improvement without them.
#pragma once

#include "jobs/cli/arguments.h"

namespace strut {

Arguments describe_diagnose();
int run_diagnose(const Arguments& arguments);

}  // namespace strut
