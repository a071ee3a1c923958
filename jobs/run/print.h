// Printed output of `strut run`: progress and summary.
#pragma once

#include <string>

#include "io/format/json.h"
#include "jobs/cli/open_sweep.h"
#include "sweep/run.h"

namespace strut {

/// The progress line: cases done, rate and time to go, of all runners on this folder that are known
/// here; `start`: now() at the start of the run.
std::string describe_progress(const RunProgress& progress, double start);

/// `seconds`: duration of the run.
Json make_json(const RunProgress& progress, const RunSummary& summary, double seconds);
void print_summary(const OpenSweep& sweep, const RunProgress& progress, const RunSummary& summary,
                   double seconds);

}  // namespace strut
