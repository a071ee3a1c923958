// A sweep as a report: how far it is, what failed, what its snapshots look like.
#pragma once

#include <string>
#include <vector>

#include "io/store/sweep_folder.h"

namespace strut {

/// Writes DIR/report.html and its figures. Throws InputError, EnvironmentError.
void write_sweep_report(const SweepFolder& folder);

}  // namespace strut
