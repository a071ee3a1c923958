// The output of a study: results.json, tables.csv, figures and a report.
#pragma once

#include <string>
#include <vector>

#include "study/results.h"

namespace strut {

/// Evaluates all models, writes all output files anew and returns the results. Throws InputError,
/// EnvironmentError.
StudyResults write_study_output(const StudyFolder& folder, const StudyRequest& request);

}  // namespace strut
