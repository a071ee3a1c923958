// strut export: a trained network as a file for other programs.
#pragma once

#include "jobs/cli/arguments.h"

namespace strut {

Arguments describe_export();
int run_export(const Arguments& arguments);

}  // namespace strut
