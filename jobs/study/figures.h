// A study's figures: what the paper draws, and how a training went.
#pragma once

#include <string>
#include <vector>

#include "jobs/study/results.h"
#include "report/chart.h"

namespace strut {

/// Of one preload: the inputs over two parameters, identified against true (the paper's Figure 6);
/// box plots of the percentage errors (7); mean absolute errors of all networks (8), of all inputs
/// (9); loss and validation against epoch. Reads the main cell's median training and its cases
/// anew. Throws InputError.
std::vector<Chart> make_study_charts(const StudyFolder& folder, const StudyRequest& request,
                                     const StudyResults& results, std::size_t preload);

}  // namespace strut
