#include "jobs/compare/figures.h"

#include <algorithm>

#include "jobs/compare/curves.h"
#include "jobs/compare/tables.h"

namespace strut {
namespace {

ChartPanel make_state_panel(const StateResidual& state, const ChannelInfo& info) {
  ChartSeries mean{"mean", SeriesKind::kLinePoints, 2}, rms{"rms", SeriesKind::kLine, 5};
  for (const StateBin& bin : state.bins) {
    if (bin.count == 0) continue;
    mean.x.push_back(bin.center);
    mean.y.push_back(bin.mean);
    rms.x.push_back(bin.center);
    rms.y.push_back(bin.rms);
  }
  return {{make_label(state.state, state.unit)}, {make_residual_label(info)}, {rms, mean}};
}

Chart make_state_chart(const CampaignData& data, const RunComparison& run) {
  Chart chart{make_run_name(data, run.run) + "_states", {}};
  chart.columns = choose_columns(run.calibrated.channels.front().states.size());
  chart.caption = "Residuals of the calibrated model by its states: mean and rms.";
  for (const ChannelComparison& channel : run.calibrated.channels) {
    const ChannelInfo& info = data.info(channel.channel);
    for (const StateResidual& state : channel.states) {
      chart.panels.push_back(make_state_panel(state, info));
    }
  }
  return chart;
}

}  // namespace

std::string make_residual_label(const ChannelInfo& info) {
  return make_label("residual of " + info.name, info.unit);
}

std::size_t choose_columns(std::size_t states) {
  constexpr std::size_t kMax = 3;
  return states % kMax == 0 ? kMax : std::min<std::size_t>(states, 2);
}

Chart make_balance_chart(const std::string& name, const std::vector<BalancePoints>& balances) {
  Chart chart{name,
              {{{"suspension deflection [m]"}, {"residual force [N]"}, {}},
               {{"suspension velocity [m/s]"}, {"residual force [N]"}, {}}},
              2};
  chart.panel_height = 400;
  for (const BalancePoints& points : balances) {
    const BodyBalance& b = *points.balance;
    ChartSeries deflection{points.name, SeriesKind::kPoints, points.color};
    ChartSeries velocity{points.name, SeriesKind::kPoints, points.color};
    const std::size_t stride = choose_stride(b.residual.size());
    for (std::size_t t = 0; t < b.residual.size(); t += stride) {
      deflection.x.push_back(b.deflection[t]);
      velocity.x.push_back(b.velocity[t]);
      deflection.y.push_back(b.residual[t]);
    }
    velocity.y = deflection.y;
    chart.panels[0].series.push_back(std::move(deflection));
    chart.panels[1].series.push_back(std::move(velocity));
  }
  return chart;
}

std::vector<Chart> make_run_charts(const CampaignData& data, const RunComparison& run) {
  std::vector<Chart> charts = {make_curve_chart(data, run.run, list_model_curves(run))};
  if (run.calibrated.channels.empty()) return charts;
  charts.push_back(make_state_chart(data, run));
  if (run.balance) {
    charts.push_back(
        make_balance_chart(make_run_name(data, run.run) + "_balance", {{"", 1, &*run.balance}}));
    charts.back().caption =
        "Body balance without the road: the force on the sprung mass that the calibrated strut "
        "does not explain.";
  }
  return charts;
}

}  // namespace strut
