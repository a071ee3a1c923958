// Which part of a sweep's parameter space is simulated, and where cases failed.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/store/dataset.h"
#include "report/chart.h"
#include "sweep/plan.h"

namespace strut {

/// Cases by the bins of one quantity.
struct CaseCount {
  std::string label;              // of its axis
  std::vector<double> centers;    // of the bins
  std::vector<double> simulated;  // with a result or failed
  std::vector<double> failed;
};

/// By layer, then by each parameter of the grid: its levels where there are few, else ten bins.
std::vector<CaseCount> count_cases(Dataset& dataset, const Plan& plan);

Chart make_coverage_chart(const std::vector<CaseCount>& counts);

}  // namespace strut
