#include "report/chart.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace strut {
namespace {

// px
constexpr double kLeftLabel = 85.0, kRightEdge = 25.0, kValueScale = 95.0;
constexpr double kBottomLabel = 60.0, kTics = 28.0, kTitle = 30.0, kNoTitle = 12.0;
constexpr int kLegendRow = 26, kLegendLine = 55;
constexpr double kLegendLetter = 7.0;

int calc_legend_height(const Chart& chart) {
  const std::vector<const ChartSeries*> entries = chart.list_legend();
  if (entries.empty()) return 0;
  int rows = 1;
  double used = 0.0;  // px of the row
  for (const ChartSeries* entry : entries) {
    const double width = kLegendLine + kLegendLetter * static_cast<double>(entry->name.size());
    if (used > 0.0 && used + width > chart.width - kLeftLabel) {
      ++rows;
      used = 0.0;
    }
    used += width;
  }
  return kLegendRow * rows + kLegendRow / 2;
}

/// Indices of the minimum, the maximum and a gap, if any, of y[begin, end).
std::set<std::size_t> pick_points(const std::vector<double>& y, std::size_t begin,
                                  std::size_t end) {
  std::size_t low = end, high = end, gap = end;
  for (std::size_t i = begin; i < end; ++i) {
    if (!std::isfinite(y[i])) {
      gap = i;
      continue;
    }
    if (low == end || y[i] < y[low]) low = i;
    if (high == end || y[i] > y[high]) high = i;
  }
  std::set<std::size_t> points = {low, high, gap};
  points.erase(end);
  return points;
}

}  // namespace

std::vector<const ChartSeries*> Chart::list_legend() const {
  std::vector<const ChartSeries*> entries;
  std::set<std::string> names = {""};
  for (const ChartPanel& panel : panels) {
    for (const ChartSeries& s : panel.series) {
      if (names.insert(s.name).second) entries.push_back(&s);
    }
  }
  return entries;
}

int calc_height(const Chart& chart) {
  return calc_legend_height(chart) + static_cast<int>(chart.rows()) * chart.panel_height;
}

PanelPlace calc_place(const Chart& chart, std::size_t panel) {
  const std::size_t row = panel / chart.columns, column = panel % chart.columns;
  const double height = calc_height(chart), all = chart.width;
  const double top =
      height - calc_legend_height(chart) - static_cast<double>(row) * chart.panel_height;
  const double width = all / static_cast<double>(chart.columns);
  const double left = width * static_cast<double>(column);
  const ChartPanel& about = chart.panels[panel];
  const bool has_label = !about.x.label.empty() || !about.x.categories.empty();
  const double below = has_label ? kBottomLabel : kTics;
  const double above = about.title.empty() ? kNoTitle : kTitle;
  const double right = about.value_label.empty() ? kRightEdge : kValueScale;
  return {(left + kLeftLabel) / all, (left + width - right) / all,
          (top - chart.panel_height + below) / height, (top - above) / height};
}

std::string name_panel(const ChartPanel& panel) {
  if (!panel.about.empty()) return panel.about;
  const std::string axes =
      panel.x.label.empty() ? panel.y.label : panel.y.label + " over " + panel.x.label;
  return panel.title.empty() ? axes : panel.title + ": " + axes;
}

ChartSeries make_curve(const std::string& name, SeriesKind kind, int color,
                       const std::vector<double>& x, const std::vector<double>& y,
                       std::size_t max_points) {
  ChartSeries curve{name, kind, color};
  const std::size_t segment =
      x.size() <= max_points ? 1 : (2 * x.size() + max_points - 1) / max_points;
  for (std::size_t begin = 0; begin < x.size(); begin += segment) {
    for (const std::size_t i : pick_points(y, begin, std::min(begin + segment, x.size()))) {
      curve.x.push_back(x[i]);
      curve.y.push_back(y[i]);
    }
  }
  return curve;
}

std::string make_words(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

std::string make_label(const std::string& name, const std::string& unit) {
  return make_words(name) + " [" + unit + "]";
}

}  // namespace strut
