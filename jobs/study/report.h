// What a study leaves behind: results.json, tables.csv, figures and a report.
#pragma once

#include <string>
#include <vector>

#include "jobs/study/results.h"

namespace strut {

struct StudyOutput {
  StudyResults results;
  std::vector<std::string> notes;  // for the user: what could not be made
};

/// Evaluates all models and writes every output anew. Throws InputError, EnvironmentError.
StudyOutput write_study_output(const StudyFolder& folder, const StudyRequest& request);

}  // namespace strut
