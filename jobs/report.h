// strut report: one HTML file about a folder of ours.
#pragma once

#include "jobs/cli/arguments.h"

namespace strut {

Arguments describe_report();
int run_report(const Arguments& arguments);

}  // namespace strut
