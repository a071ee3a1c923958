#include "jobs/compare/figures.h"

#include "jobs/compare/curves.h"
#include "jobs/compare/tables.h"
#include "jobs/report/panels.h"

namespace strut {
namespace {

using Points = std::vector<std::vector<double>>;

Panel make_state_panel(const StateResidual& state, const std::string& y_label) {
  Points mean, rms;
  for (const StateBin& bin : state.bins) {
    if (bin.count == 0) continue;
    mean.push_back({bin.center, bin.mean});
    rms.push_back({bin.center, bin.rms});
  }
  return {make_words(state.state) + " [" + state.unit + "]",
          y_label,
          {{"rms", "lines linetype 5", rms},
           {"mean", "linespoints linetype 2 pointtype 7 pointsize 0.5", mean}}};
}

Figure make_state_figure(const CampaignData& data, const RunComparison& run) {
  std::vector<Panel> panels;
  for (const ChannelComparison& channel : run.calibrated.channels) {
    const ChannelInfo& info = data.info(channel.channel);
    std::string y_label = make_words(info.name) + " [" + info.unit + "]";
    for (const StateResidual& state : channel.states) {
      panels.push_back(make_state_panel(state, y_label));
      y_label.clear();
    }
  }
  return make_panel_figure(make_run_name(data, run.run) + "_states",
                           run.calibrated.channels.front().states.size(), panels);
}

Figure make_balance_figure(const CampaignData& data, const RunComparison& run) {
  return make_panel_figure(make_run_name(data, run.run) + "_balance", 2,
                           make_balance_panels({{"", 1, &*run.balance}}));
}

}  // namespace

std::vector<Panel> make_balance_panels(const std::vector<BalancePoints>& balances) {
  std::vector<Panel> panels = {{"suspension deflection [m]", "force left [N]", {}},
                               {"suspension velocity [m/s]", "", {}}};
  for (const BalancePoints& points : balances) {
    const BodyBalance& b = *points.balance;
    const std::size_t stride = choose_stride(b.residual.size());
    Points deflection, velocity;
    for (std::size_t t = 0; t < b.residual.size(); t += stride) {
      deflection.push_back({b.deflection[t], b.residual[t]});
      velocity.push_back({b.velocity[t], b.residual[t]});
    }
    const std::string style =
        "points linetype " + std::to_string(points.line_type) + " pointtype 7 pointsize 0.15";
    panels[0].lines.push_back({points.name, style, std::move(deflection)});
    panels[1].lines.push_back({points.name, style, std::move(velocity)});
  }
  return panels;
}

std::vector<std::pair<Figure, std::string>> make_run_figures(const CampaignData& data,
                                                             const RunComparison& run) {
  std::vector<std::pair<Figure, std::string>> figures;
  figures.emplace_back(make_curve_figure(data, run.run, list_model_curves(run)),
                       "Measured and simulated, and what is left, over time.");
  if (run.calibrated.channels.empty()) return figures;
  figures.emplace_back(make_state_figure(data, run),
                       "What the calibrated model leaves, by its states: mean and rms.");
  if (run.balance) {
    figures.emplace_back(make_balance_figure(data, run),
                         "Body balance without road: the force that the sprung mass shows and the "
                         "calibrated strut does not give.");
  }
  return figures;
}

}  // namespace strut
