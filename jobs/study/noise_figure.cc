#include "jobs/study/noise_figure.h"

namespace strut {
namespace {

constexpr int kWindowColor = 3;

/// A series with one value per scale.
template <class Get>
ChartSeries make_series(const NoiseStudy& study, std::size_t p, const std::string& name,
                        SeriesKind kind, int color, const Get& get) {
  ChartSeries series{name, kind, color};
  for (const NoisePoint& point : study.points) {
    series.x.push_back(point.scale);
    series.y.push_back(get(point.errors[p]));
  }
  return series;
}

std::vector<ChartSeries> list_series(const NoiseStudy& study, std::size_t p) {
  std::vector<ChartSeries> all;
  const auto add = [&](const std::string& name, SeriesKind kind, int color, Marker marker,
                       const auto& get) {
    all.push_back(make_series(study, p, name, kind, color, get));
    all.back().marker = marker;
  };
  for (std::size_t i = 0; i < study.preloads.size(); ++i) {
    const int color = static_cast<int>(i) + 1;
    const std::string label = "snapshot, " + make_words(study.preloads[i]);
    add(label + ": bound", SeriesKind::kLine, color, Marker::kDot,
        [i](const NoiseErrors& e) { return e.snapshots[i].bound; });
    add(label + ": network", SeriesKind::kPoints, color, Marker::kDot,
        [i](const NoiseErrors& e) { return e.snapshots[i].network; });
  }
  add("window: bound", SeriesKind::kLine, kWindowColor, Marker::kDot,
      [](const NoiseErrors& e) { return e.window.bound; });
  add("window: network", SeriesKind::kPoints, kWindowColor, Marker::kDot,
      [](const NoiseErrors& e) { return e.window.network; });
  add("window: fit", SeriesKind::kPoints, kWindowColor, Marker::kTriangle,
      [](const NoiseErrors& e) { return e.window.fit; });
  add("spread of the grid", SeriesKind::kDashedLine, kInk, Marker::kDot,
      [&](const NoiseErrors&) { return study.spread[p]; });
  return all;
}

}  // namespace

Chart make_noise_chart(const NoiseStudy& study) {
  constexpr double kMargin = 1.3;  // factor beyond the first and the last scale
  Chart chart{"noise", {}, 2};
  chart.panel_height = 425;
  chart.caption =
      "Root mean square errors over the noise, on test cases. Lines: Cramer-Rao bounds; circles: "
      "networks; triangles: fits of the simulation; dashed: the error of an estimate that is "
      "always the middle of the grid.";
  const double low = study.points.front().scale, high = study.points.back().scale;
  for (std::size_t p = 0; p < study.parameters.size(); ++p) {
    const ColumnInfo& parameter = study.parameters[p];
    chart.panels.push_back({{"noise; 1: real sensors", true, {}, {low / kMargin, high * kMargin}},
                            {make_label("error", parameter.unit), true},
                            list_series(study, p),
                            make_words(parameter.name)});
  }
  return chart;
}

}  // namespace strut
