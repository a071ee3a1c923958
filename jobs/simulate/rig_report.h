// The report of one simulated run of a rig: a page with its curves.
#pragma once

#include "jobs/simulate/options.h"
#include "jobs/simulate/run_file.h"

namespace strut {

/// Writes FOLDER/report.html and its figure, FOLDER being options.report. Throws EnvironmentError.
void write_rig_report(const SimulateOptions& options, const RunRecord& run);

}  // namespace strut
