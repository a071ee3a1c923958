#include "jobs/study/bars.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace strut {
namespace {

/// One bar: a cell, its label below the axis, and its series with color.
struct Bar {
  const CellResult* cell;
  std::string label, series;
  int color;
};

/// A chart of mean absolute errors, one panel per parameter.
struct Bars {
  std::string name, caption;
  std::vector<Bar> bars;
};

/// The series of a bar, appended where there is none yet.
ChartSeries& find_or_add_series(std::vector<ChartSeries>& all, const Bar& bar) {
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const ChartSeries& s) { return s.name == bar.series; });
  if (found != all.end()) return *found;
  all.push_back({bar.series, SeriesKind::kBars, bar.color});
  all.back().width = kBarWidth;
  return all.back();
}

/// Range of a logarithmic axis of bars: it starts at the decade below the smallest value, as bars
/// have no zero there.
std::vector<double> calc_range(const std::vector<ChartSeries>& all) {
  double lowest = 1e300, highest = 0.0;
  for (const ChartSeries& s : all) {
    for (std::size_t i = 0; i < s.y.size(); ++i) {
      if (!std::isfinite(s.y[i])) continue;
      lowest = std::min(lowest, s.low.empty() ? s.y[i] : s.low[i]);
      highest = std::max(highest, s.high.empty() ? s.y[i] : s.high[i]);
    }
  }
  return {std::pow(10.0, std::floor(std::log10(std::max(lowest, 1e-12) * 0.5))), highest * 3.0};
}

ChartPanel make_panel(const StudyRequest& request, const Bars& bars, std::size_t p) {
  const ColumnInfo& parameter = bars.bars.front().cell->parameters[p];
  ChartPanel panel{{""}, {make_label("MAE", parameter.unit), true}, {}, make_words(parameter.name)};
  ChartSeries published{"the paper", SeriesKind::kPoints, kInk};
  published.marker = Marker::kTriangle;
  for (const Bar& bar : bars.bars) {
    const Spread& mae = bar.cell->spread[p][kMae];
    panel.x.categories.push_back(bar.label);
    const auto x = static_cast<double>(panel.x.categories.size());
    ChartSeries& series = find_or_add_series(panel.series, bar);
    series.x.push_back(x);
    series.y.push_back(mae.median);
    series.low.push_back(mae.low);
    series.high.push_back(mae.high);
    const double theirs = find_published(request, *bar.cell, p, kMae);
    if (std::isnan(theirs)) continue;
    published.x.push_back(x);
    published.y.push_back(theirs);
  }
  if (!published.x.empty()) panel.series.push_back(published);
  panel.x.range = {0.3, static_cast<double>(bars.bars.size()) + 0.7};
  panel.y.range = calc_range(panel.series);
  return panel;
}

Chart make_bar_chart(const StudyRequest& request, const Bars& bars) {
  Chart chart{bars.name, {}, 2};
  chart.panel_height = 380;
  chart.caption = bars.caption;
  const std::size_t parameters = bars.bars.front().cell->parameters.size();
  for (std::size_t p = 0; p < parameters; ++p) {
    chart.panels.push_back(make_panel(request, bars, p));
  }
  return chart;
}

std::string describe_bars(const StudyRequest& request) {
  return fmt::format(" Bars: {}; triangles: the paper. The scale is logarithmic.",
                     request.seeds == 1
                         ? "one training each"
                         : "median over the seeds, with the smallest and the largest value");
}

Bars make_network_bars(const StudyRequest& request, const StudyResults& results,
                       std::size_t preload) {
  Bars bars;
  bars.name = "networks_" + request.preloads[preload].name;
  bars.caption = fmt::format(
      "As Figure 8 of the paper. Mean absolute errors of all networks and numbers of cases.{}",
      describe_bars(request));
  for (const CellResult& cell : results.cells) {
    const StudyCell& c = cell.cell;
    if (c.preload != preload || c.inputs != request.main_inputs || c.best_instant) continue;
    const std::string samples = std::to_string(request.samples[c.samples]);
    bars.bars.push_back({&cell, request.networks[c.network].name + " " + samples,
                         samples + " cases", 1 + static_cast<int>(c.samples % 3) * 2});
  }
  return bars;
}

Bars make_input_bars(const StudyRequest& request, const StudyResults& results,
                     std::size_t preload) {
  Bars bars;
  bars.name = "inputs_" + request.preloads[preload].name;
  bars.caption = fmt::format(
      "As Figure 9 of the paper. Mean absolute errors with different inputs and instants.{}",
      describe_bars(request));
  for (const CellResult& cell : results.cells) {
    const StudyCell& c = cell.cell;
    const bool here = c.preload == preload && c.samples == request.main_samples &&
                      c.network == request.main_network;
    if (!here) continue;
    bars.bars.push_back({&cell, request.inputs[c.inputs].name + (c.best_instant ? ", best" : ""),
                         c.best_instant ? "best instant" : "the sweep's instant",
                         c.best_instant ? 3 : 1});
  }
  return bars;
}

}  // namespace

std::vector<Chart> make_bar_charts(const StudyRequest& request, const StudyResults& results,
                                   std::size_t preload) {
  std::vector<Chart> charts;
  for (const auto& make : {make_network_bars, make_input_bars}) {
    const Bars bars = make(request, results, preload);
    if (bars.bars.size() > 1) charts.push_back(make_bar_chart(request, bars));
  }
  return charts;
}

}  // namespace strut
