// strut study: a table of trainings, from sweeps to a report.
#pragma once

#include "jobs/cli/arguments.h"

namespace strut {

Arguments describe_study();
int run_study(const Arguments& arguments);

}  // namespace strut
