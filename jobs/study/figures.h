// The figures of a study: those of the paper, and the course of a training.
#pragma once

#include <string>
#include <vector>

#include "report/chart.h"
#include "study/results.h"

namespace strut {

/// The charts of one preload: inputs over two parameters, true and identified (the paper's Figure
/// 6); box plots of the percentage errors (7); mean absolute errors of all networks (8) and of all
/// inputs (9); training and validation loss over the epochs. Reads the median training of the main
/// cell and its test cases. Throws InputError.
std::vector<Chart> make_study_charts(const StudyFolder& folder, const StudyRequest& request,
                                     const StudyResults& results, std::size_t preload);

}  // namespace strut
