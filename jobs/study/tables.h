// A study's tables and lines of text, for the terminal and the report.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "report/html.h"
#include "study/summary.h"

namespace strut {

enum class TableDetail {
  kMedian,  // narrow enough for a terminal
  kSpread,  // with the smallest and the largest value over the seeds
};

/// The tables of one preload: networks, one table per number of cases, then inputs and instants.
/// Each metric is shown with the published number and their ratio.
std::vector<ReportTable> make_study_tables(const StudyRequest& request, const StudyResults& results,
                                           std::size_t preload, TableDetail detail);

/// "four inputs", "five inputs, snapshot at -0.202 m"
std::string describe_inputs(const StudyRequest& request, const CellResult& cell);

/// One line: the errors within the aim, and the largest.
std::string describe_summary(const StudySummary& summary);

}  // namespace strut
