#include "jobs/compare/figures.h"

#include <algorithm>
#include <limits>

#include "jobs/compare/tables.h"

namespace strut {
namespace {

using Rows = std::vector<std::vector<double>>;

/// More points are not seen, and make a report too large to mail.
constexpr std::size_t kMostPoints = 2500;

std::size_t choose_stride(std::size_t count) { return 1 + count / kMostPoints; }

double read(const ModelComparison& model, int channel, std::size_t time) {
  if (!model.evaluation.failure.empty()) return std::numeric_limits<double>::quiet_NaN();
  return model.evaluation.curves.channel[static_cast<std::size_t>(channel)][time];
}

/// time, measured, nominal, calibrated, residual of both
Rows make_curve_rows(const CampaignData& data, const RunComparison& run, const MeasuredChannel& c) {
  const std::vector<double>& times = data.times(run.run);
  const std::size_t stride = choose_stride(times.size());
  Rows rows;
  rows.reserve(times.size() / stride + 1);
  for (std::size_t t = 0; t < times.size(); t += stride) {
    const double before = read(run.nominal, c.channel, t);
    const double after = read(run.calibrated, c.channel, t);
    rows.push_back(
        {times[t], c.values[t], before, after, c.values[t] - before, c.values[t] - after});
  }
  return rows;
}

Figure make_curve_figure(const CampaignData& data, const RunComparison& run) {
  const std::vector<MeasuredChannel>& channels = data.channels(run.run);
  const std::string panels = std::to_string(2 * channels.size());
  Figure figure{make_run_name(data, run.run) + "_time", 1000,
                static_cast<int>(360 * channels.size() + 60), ""};
  std::string& text = figure.commands;
  text = "set multiplot layout " + panels +
         ",1 margins 0.1,0.97,0.08,0.96 spacing 0.05\n"
         "set grid\nset key outside above horizontal\nset format x ''\n";
  for (std::size_t k = 0; k < channels.size(); ++k) {
    const ChannelInfo& info = data.info(channels[k].channel);
    const std::string block = "$channel" + std::to_string(k);
    text += make_data(block.substr(1), make_curve_rows(data, run, channels[k]));
    text += "set ylabel " + quote_figure_text(make_words(info.name) + " [" + info.unit + "]") +
            "\nplot " + block + " using 1:2 with lines linetype 1 title 'measured', " + block +
            " using 1:3 with lines linetype 5 title 'nominal', " + block +
            " using 1:4 with lines linetype 2 title 'calibrated'\nunset key\n";
    if (k + 1 == channels.size()) text += "set format x '%g'\nset xlabel 'time [s]'\n";
    text += "set ylabel 'residual [" + info.unit + "]'\nplot " + block +
            " using 1:5 with lines linetype 5 notitle, " + block +
            " using 1:6 with lines linetype 2 notitle\n";
  }
  text += "unset multiplot\n";
  return figure;
}

Figure make_state_figure(const CampaignData& data, const RunComparison& run) {
  const std::vector<ChannelComparison>& channels = run.calibrated.channels;
  const std::size_t states = channels.front().states.size();
  Figure figure{make_run_name(data, run.run) + "_states", 1000,
                static_cast<int>(260 * channels.size() + 60), ""};
  std::string& text = figure.commands;
  text = "set multiplot layout " + std::to_string(channels.size()) + "," + std::to_string(states) +
         " margins 0.13,0.97,0.14,0.95 spacing 0.09,0.14\nset grid\nset xzeroaxis\n"
         "set tics font ',10'\nset xtics rotate by -35\n";
  for (std::size_t k = 0; k < channels.size(); ++k) {
    for (std::size_t s = 0; s < states; ++s) {
      const StateResidual& state = channels[k].states[s];
      Rows rows;
      rows.reserve(state.bins.size());
      for (const StateBin& bin : state.bins) {
        if (bin.count > 0) rows.push_back({bin.center, bin.mean, bin.rms});
      }
      if (rows.empty()) rows.push_back({0.0, 0.0, 0.0});
      const std::string block = "state" + std::to_string(k) + "_" + std::to_string(s);
      const ChannelInfo& info = data.info(channels[k].channel);
      text += make_data(block, rows);
      text += "set xlabel " + quote_figure_text(make_words(state.state) + " [" + state.unit + "]") +
              "\nset ylabel " +
              quote_figure_text(s == 0 ? make_words(info.name) + " [" + info.unit + "]" : "") +
              "\nplot $" + block + " using 1:3 with lines linetype 5 title 'rms', $" + block +
              " using 1:2 with linespoints linetype 2 pointtype 7 pointsize 0.5 title 'mean'\n"
              "unset key\n";
    }
  }
  text += "unset multiplot\n";
  return figure;
}

Figure make_balance_figure(const CampaignData& data, const RunComparison& run) {
  const BodyBalance& b = *run.balance;
  const std::size_t stride = choose_stride(b.force.size());
  Rows rows;
  rows.reserve(b.force.size() / stride + 1);
  for (std::size_t t = 0; t < b.force.size(); t += stride) {
    rows.push_back({b.deflection[t], b.velocity[t], b.force[t], b.residual[t]});
  }
  Figure figure{make_run_name(data, run.run) + "_balance", 1000, 420, ""};
  figure.commands =
      make_data("balance", rows) +
      "set multiplot layout 1,2 margins 0.09,0.97,0.15,0.93 spacing 0.1,0.1\nset grid\nunset key\n"
      "set xzeroaxis\nset ylabel 'force left [N]'\nset xlabel 'suspension deflection [m]'\n"
      "plot $balance using 1:4 with points linetype 1 pointtype 7 pointsize 0.15\n"
      "set ylabel ''\nset xlabel 'suspension velocity [m/s]'\n"
      "plot $balance using 2:4 with points linetype 1 pointtype 7 pointsize 0.15\n"
      "unset multiplot\n";
  return figure;
}

}  // namespace

std::vector<std::pair<Figure, std::string>> make_run_figures(const CampaignData& data,
                                                             const RunComparison& run) {
  std::vector<std::pair<Figure, std::string>> figures;
  figures.emplace_back(make_curve_figure(data, run),
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
