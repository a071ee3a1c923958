// Small errors of sensors, as estimated by a fit: gains and skews within their tolerances.
#pragma once

#include <string>
#include <vector>

#include "estimate/fit.h"

namespace strut {

struct SensorFinding {
  std::string name, unit;                     // of the unknown
  double value = 0.0, low = 0.0, high = 0.0;  // with its 95 % interval, widened by the misfit
  double tolerance = 0.0;                     // 1 sigma of the prior
};

/// The gain errors and skews that all runs share.
std::vector<SensorFinding> list_sensor_findings(const FitResult& fit);

/// Those of at least two tolerances in one line; empty if there is none.
std::string describe_sensor_findings(const FitResult& fit);

}  // namespace strut
