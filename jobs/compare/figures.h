// Figures of one run's comparison.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "diagnose/compare.h"
#include "jobs/report/panels.h"

namespace strut {

/// With captions: measured, nominal and calibrated curves over time with residuals; residuals by
/// state; with a body balance its force over velocity.
std::vector<std::pair<Figure, std::string>> make_run_figures(const CampaignData& data,
                                                             const RunComparison& run);

/// A body balance under a name and in the line type of its points.
struct BalancePoints {
  std::string name;
  int line_type = 1;
  const BodyBalance* balance = nullptr;
};

/// The force left over deflection, and over velocity.
std::vector<Panel> make_balance_panels(const std::vector<BalancePoints>& balances);

}  // namespace strut
