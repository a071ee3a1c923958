#include "jobs/compare/curves.h"

#include <algorithm>
#include <functional>
#include <iterator>

namespace strut {
namespace {

constexpr std::size_t kMostPoints = 2500;

std::vector<ModelCurves> keep_simulated(const std::vector<ModelCurves>& models) {
  std::vector<ModelCurves> kept;
  std::copy_if(models.begin(), models.end(), std::back_inserter(kept),
               [](const ModelCurves& model) { return model.is_simulated(); });
  return kept;
}

const std::vector<double>& get_curve(const ModelCurves& model, int channel) {
  return model.evaluation->curves.channel[static_cast<std::size_t>(channel)];
}

/// Every so many of the values, as a report needs them.
std::vector<double> thin(const std::vector<double>& values) {
  const std::size_t stride = choose_stride(values.size());
  std::vector<double> kept;
  kept.reserve(values.size() / stride + 1);
  for (std::size_t t = 0; t < values.size(); t += stride) kept.push_back(values[t]);
  return kept;
}

std::vector<double> calc_residual(const MeasuredChannel& c, const std::vector<double>& simulated) {
  std::vector<double> residual(c.values.size());
  std::transform(c.values.begin(), c.values.end(), simulated.begin(), residual.begin(),
                 std::minus<>());
  return residual;
}

/// A channel's curves, and a panel of what the models leave of it.
void add_channel(const std::vector<double>& times, const MeasuredChannel& c,
                 const ChannelInfo& info, const std::vector<ModelCurves>& models,
                 std::vector<ChartPanel>& panels) {
  const std::vector<double> x = thin(times);
  ChartPanel curves{{""}, {make_label(info.name, info.unit)}, {}};
  ChartPanel residuals{{"time [s]"}, {make_label("residual", info.unit)}, {}};
  curves.series.push_back({"measured", SeriesKind::kLine, 1, x, thin(c.values)});
  for (const ModelCurves& model : models) {
    const std::vector<double>& simulated = get_curve(model, c.channel);
    curves.series.push_back({model.name, SeriesKind::kLine, model.color, x, thin(simulated)});
    residuals.series.push_back(
        {model.name, SeriesKind::kLine, model.color, x, thin(calc_residual(c, simulated))});
  }
  panels.push_back(std::move(curves));
  panels.push_back(std::move(residuals));
}

}  // namespace

std::string make_run_name(const CampaignData& data, std::size_t run) {
  std::string name =
      "run_" + std::to_string(run + 1) + "_" + data.campaign.runs[run].file.stem().string();
  for (char& c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (!plain && c != '-') c = '_';
  }
  return name;
}

std::size_t choose_stride(std::size_t count) { return 1 + count / kMostPoints; }

Chart make_curve_chart(const CampaignData& data, std::size_t run,
                       const std::vector<ModelCurves>& models) {
  Chart chart{make_run_name(data, run) + "_time", {}};
  chart.panel_height = 240;
  chart.shares_x = true;
  chart.caption = "Measured and simulated, and what is left, over time.";
  for (const MeasuredChannel& c : data.channels(run)) {
    add_channel(data.times(run), c, data.info(c.channel), keep_simulated(models), chart.panels);
  }
  return chart;
}

std::vector<CsvColumn> make_curve_columns(const CampaignData& data, std::size_t run,
                                          const std::vector<ModelCurves>& models) {
  std::vector<CsvColumn> columns = {{"time", "s", data.times(run)}};
  for (const MeasuredChannel& c : data.channels(run)) {
    const ChannelInfo& info = data.info(c.channel);
    columns.push_back({info.name, info.unit, c.values});
    for (const ModelCurves& model : keep_simulated(models)) {
      columns.push_back({info.name + "_" + model.name, info.unit, get_curve(model, c.channel)});
    }
  }
  return columns;
}

}  // namespace strut
