// What a study leaves behind: results.json, tables.csv, figures and a report.
#pragma once

#include <string>
#include <vector>

#include "jobs/html.h"
#include "jobs/study_results.h"

namespace strut {

struct StudyOutput {
  StudyResults results;
  std::vector<std::string> notes;  // for the user: what could not be made
};

/// Evaluates all models and writes every output anew. `extra`: sections of other computations on
/// the same study, which come behind the tables and figures. Throws InputError, EnvironmentError.
StudyOutput write_study_output(const StudyFolder& folder, const StudyRequest& request,
                               const std::vector<ReportSection>& extra = {});

}  // namespace strut
