// A study's tables as people read them, in the terminal and in the report.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "jobs/study/results.h"
#include "report/html.h"

namespace strut {

enum class TableDetail {
  kMedian,  // narrow enough for a terminal
  kSpread,  // with the smallest and largest value over the seeds
};

/// Of one preload: a table of networks for each number of cases, then the one that compares inputs
/// and instants. Each metric stands beside the published number and their ratio.
std::vector<ReportTable> make_study_tables(const StudyRequest& request, const StudyResults& results,
                                           std::size_t preload, TableDetail detail);

/// "four inputs", "five inputs, snapshot at -0.202 m"
std::string describe_inputs(const StudyRequest& request, const CellResult& cell);

}  // namespace strut
