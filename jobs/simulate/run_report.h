// The report of one simulated run: a page with the car in motion and its curves.
#pragma once

#include <filesystem>
#include <optional>

#include "jobs/simulate/motion.h"
#include "jobs/simulate/run_file.h"
#include "model/car/case.h"
#include "report/html.h"

namespace strut {

/// "paper_sedan over bump_20mps, front_damping = 500"
std::string make_run_title(const CaseSource& source);
/// All parameters of a run.
ReportTable make_parameter_table(const RunRecord& run);
/// Program, files and settings of a run; folded.
ReportTable make_source_table(const RunRecord& run);

/// Writes FOLDER/report.html and its figures; `rate` [Hz]: of the run's history; `other`: a run to
/// be drawn over it. Throws EnvironmentError.
void write_run_report(const std::filesystem::path& folder, const CaseSource& source, const Case& c,
                      const RunRecord& run, double rate, const std::optional<OtherRun>& other);

}  // namespace strut
