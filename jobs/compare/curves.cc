#include "jobs/compare/curves.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <iterator>

namespace strut {
namespace {

constexpr std::size_t kMaxPoints = 2500;  // points of a point cloud

std::vector<ModelCurves> keep_simulated(const std::vector<ModelCurves>& models) {
  std::vector<ModelCurves> kept;
  std::copy_if(models.begin(), models.end(), std::back_inserter(kept),
               [](const ModelCurves& model) { return model.is_simulated(); });
  return kept;
}

const std::vector<double>& get_curve(const ModelCurves& model, int channel) {
  return model.evaluation->curves.channel[static_cast<std::size_t>(channel)];
}

std::vector<double> calc_residual(const MeasuredChannel& c, const std::vector<double>& simulated) {
  std::vector<double> residual(c.values.size());
  std::transform(c.values.begin(), c.values.end(), simulated.begin(), residual.begin(),
                 std::minus<>());
  return residual;
}

/// Points of a curve such that those of all runs make a page that can be mailed.
std::size_t choose_curve_points(std::size_t runs, std::size_t channels, std::size_t models) {
  constexpr std::size_t kPagePoints = 60'000, kMinPoints = 300;
  const std::size_t curves = runs * channels * (2 * models + 1);
  return std::clamp(kPagePoints / std::max<std::size_t>(curves, 1), kMinPoints, kCurvePoints);
}

/// Adds two panels: a channel's curves, and the models' residuals.
void add_channel(const std::vector<double>& times, const MeasuredChannel& c,
                 const ChannelInfo& info, const std::vector<ModelCurves>& models,
                 std::size_t points, std::vector<ChartPanel>& panels) {
  const std::string label = make_label(info.name, info.unit);
  ChartPanel curves{{""}, {label}, {}};
  ChartPanel residuals{{"time [s]"}, {make_label("residual", info.unit)}, {}};
  curves.about = label + " over time [s]";
  residuals.about = "residual of " + curves.about;
  for (const ModelCurves& model : models) {
    const std::vector<double>& simulated = get_curve(model, c.channel);
    const auto make = [&](const std::vector<double>& values) {
      return make_curve(model.name, SeriesKind::kLine, model.color, times, values, points);
    };
    curves.series.push_back(make(simulated));
    residuals.series.push_back(make(calc_residual(c, simulated)));
  }
  // Drawn last, above the models.
  curves.series.push_back(
      make_curve("measured", SeriesKind::kLine, kMeasuredColor, times, c.values, points));
  panels.push_back(std::move(curves));
  panels.push_back(std::move(residuals));
}

}  // namespace

std::string make_run_name(const CampaignData& data, std::size_t run) {
  std::string name =
      fmt::format("run_{}_{}", run + 1, data.campaign.runs[run].file.stem().string());
  for (char& c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (!plain && c != '-') c = '_';
  }
  return name;
}

std::vector<std::string> list_run_tables(const CampaignData& data) {
  std::vector<std::string> names;
  for (std::size_t run = 0; run < data.campaign.runs.size(); ++run) {
    names.push_back(make_run_name(data, run) + ".csv");
  }
  return names;
}

std::size_t choose_stride(std::size_t count) { return 1 + count / kMaxPoints; }

Chart make_curve_chart(const CampaignData& data, std::size_t run,
                       const std::vector<ModelCurves>& models) {
  Chart chart{make_run_name(data, run) + "_time", {}};
  chart.panel_height = 240;
  chart.shares_x = true;
  chart.caption = "Measured and simulated curves over time, with residuals.";
  const std::vector<ModelCurves> simulated = keep_simulated(models);
  const std::vector<MeasuredChannel>& channels = data.channels(run);
  const std::size_t points =
      choose_curve_points(data.run_count(), channels.size(), simulated.size());
  for (const MeasuredChannel& c : channels) {
    add_channel(data.times(run), c, data.info(c.channel), simulated, points, chart.panels);
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
