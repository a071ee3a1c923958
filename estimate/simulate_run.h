// One measured run as the model has it: every channel at the times of the readings.
#pragma once

#include <string>
#include <vector>

#include "estimate/unknown.h"

namespace strut {

struct RunCurves {
  std::string failure;                       // empty: it got through
  std::vector<std::vector<double>> channel;  // [channel of the model][time]; NaN: not simulated
};

/// At `values` of `unknowns`, of which those with Unknown::run kEveryRun or 0 are this run's;
/// biases are added to the channels they belong to. Throws InputError where a value is out of its
/// range.
RunCurves simulate_run(const MeasuredRun& run, const std::vector<Unknown>& unknowns,
                       const std::vector<double>& values);

}  // namespace strut
