// Bars of mean absolute errors, one panel a parameter.
#pragma once

#include <vector>

#include "jobs/study/figures.h"

namespace strut {

/// Of all networks and numbers of cases, as the paper's Figure 8, and of all inputs and instants,
/// as its Figure 9; without those of only one bar, which compares nothing.
std::vector<Chart> make_bar_charts(const StudyRequest& request, const StudyResults& results,
                                   std::size_t preload);

}  // namespace strut
