// The report of one simulated run: a page with the car in motion and its curves.
#pragma once

#include <filesystem>
#include <optional>

#include "jobs/simulate/motion.h"
#include "jobs/simulate/run_file.h"
#include "model/car/case.h"

namespace strut {

/// Writes FOLDER/report.html and its figures; `rate` [Hz]: of the run's history; `other`: a run to
/// be drawn over it. Throws EnvironmentError.
void write_run_report(const std::filesystem::path& folder, const CaseSource& source, const Case& c,
                      const RunRecord& run, double rate, const std::optional<OtherRun>& other);

}  // namespace strut
