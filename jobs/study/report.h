// What a study leaves behind: results.json, tables.csv, figures and a report.
#pragma once

#include <string>
#include <vector>

#include "jobs/study/results.h"

namespace strut {

/// Evaluates all models and writes every output anew. Throws InputError, EnvironmentError.
StudyResults write_study_output(const StudyFolder& folder, const StudyRequest& request);

}  // namespace strut
