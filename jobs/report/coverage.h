// Coverage of a sweep's parameter space: simulated and failed cases by stratum and parameter.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/store/dataset.h"
#include "report/chart.h"
#include "sweep/plan.h"

namespace strut {

/// Number of cases in the bins of one quantity.
struct CaseCount {
  std::string label;              // label of the axis
  std::vector<double> centers;    // centers of the bins
  std::vector<double> simulated;  // with a result, or failed
  std::vector<double> failed;
};

/// Counts cases by stratum, then by each parameter of the grid: by its levels if there are few,
/// otherwise in ten bins.
std::vector<CaseCount> count_cases(Dataset& dataset, const Plan& plan);

Chart make_coverage_chart(const std::vector<CaseCount>& counts);

}  // namespace strut
