// A sweep as a report: how far it is, what failed, what its snapshots look like.
#pragma once

#include <string>
#include <vector>

#include "io/store/sweep_folder.h"

namespace strut {

/// Writes DIR/report.html and its figures. Returns what could not be made, for the user. Throws
/// InputError, EnvironmentError.
std::vector<std::string> write_sweep_report(const SweepFolder& folder);

}  // namespace strut
