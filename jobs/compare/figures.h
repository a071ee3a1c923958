// Charts of one run's comparison.
#pragma once

#include <string>
#include <vector>

#include "diagnose/compare/compare.h"
#include "report/chart.h"

namespace strut {

/// Measured, nominal and calibrated curves over time with residuals; residuals by state; where
/// there is a body balance, its force over deflection and velocity.
std::vector<Chart> make_run_charts(const CampaignData& data, const RunComparison& run);

/// A body balance, with a name and the color of its points.
struct BalancePoints {
  std::string name;
  int color = 1;
  const BodyBalance* balance = nullptr;
};

/// "residual of pitch rate [rad/s]"
std::string make_residual_label(const ChannelInfo& info);

/// Number of columns of a chart with one or two rows of `states` panels per channel.
std::size_t choose_columns(std::size_t states);

/// The residual force over deflection and over velocity.
Chart make_balance_chart(const std::string& name, const std::vector<BalancePoints>& balances);

}  // namespace strut
