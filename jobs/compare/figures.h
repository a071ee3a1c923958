// Figures of one run's comparison.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "diagnose/compare.h"
#include "jobs/report/figure.h"

namespace strut {

/// With captions: measured, nominal and calibrated curves over time with residuals; residuals by
/// state; with a body balance its force over velocity.
std::vector<std::pair<Figure, std::string>> make_run_figures(const CampaignData& data,
                                                             const RunComparison& run);

}  // namespace strut
