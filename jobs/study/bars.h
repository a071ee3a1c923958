// Bars of mean absolute errors, one panel a parameter.
#pragma once

#include <vector>

#include "jobs/study/figures.h"

namespace strut {

/// All networks and numbers of cases (the paper's Figure 8), and all inputs and instants (its
/// Figure 9). A chart with only one bar, which compares nothing, is left out.
std::vector<Chart> make_bar_charts(const StudyRequest& request, const StudyResults& results,
                                   std::size_t preload);

}  // namespace strut
