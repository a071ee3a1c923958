// The files of a study's results: results.json, tables.csv and noise.csv.
#pragma once

#include <string>

#include "io/format/json.h"
#include "study/results.h"

namespace strut {

Json make_json(const StudyRequest& request, const StudyResults& results);

/// One row per number, with its unit.
std::string make_csv(const StudyRequest& request, const StudyResults& results);

/// Writes the files into the study's folder. Throws EnvironmentError; InputError where one of them
/// is a link.
void write_result_files(const StudyFolder& folder, const StudyRequest& request,
                        const StudyResults& results);

}  // namespace strut
