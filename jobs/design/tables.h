// The output of `strut design` on the terminal.
#pragma once

#include "jobs/case/design_report.h"

namespace strut {

/// Prints tables on standard output.
void print_design(const DesignReport& report);

}  // namespace strut
