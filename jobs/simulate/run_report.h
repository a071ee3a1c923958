// The report of one simulated run: a page with the car in motion and its curves.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "jobs/simulate/run_file.h"
#include "model/car/case.h"

namespace strut {

/// Writes FOLDER/report.html and its figures. Throws EnvironmentError.
void write_run_report(const std::filesystem::path& folder, const CaseSource& source, const Case& c,
                      const RunRecord& run);

}  // namespace strut
