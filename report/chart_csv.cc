#include "report/chart_csv.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/text/format_number.h"

namespace strut {
namespace {

std::string quote(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

struct Column {
  const char* name;
  std::vector<double> ChartSeries::*values;
};

constexpr std::array<Column, 5> kColumns = {{{"x", &ChartSeries::x},
                                             {"y", &ChartSeries::y},
                                             {"value", &ChartSeries::value},
                                             {"low", &ChartSeries::low},
                                             {"high", &ChartSeries::high}}};

bool has_values(const Chart& chart, const Column& column) {
  return std::any_of(chart.panels.begin(), chart.panels.end(), [&](const ChartPanel& panel) {
    return std::any_of(panel.series.begin(), panel.series.end(),
                       [&](const ChartSeries& s) { return !(s.*column.values).empty(); });
  });
}

std::string print(const std::vector<double>& values, std::size_t i) {
  return i < values.size() && std::isfinite(values[i]) ? format_number(values[i]) : "";
}

bool has_categories(const Chart& chart) {
  return std::any_of(chart.panels.begin(), chart.panels.end(),
                     [](const ChartPanel& panel) { return !panel.x.categories.empty(); });
}

/// The category of a bar, box or point, quoted; empty for lines, which cross categories.
std::string name_category(const ChartPanel& panel, const ChartSeries& s, double x) {
  const bool has_category =
      s.kind == SeriesKind::kBars || s.kind == SeriesKind::kBoxes || s.kind == SeriesKind::kPoints;
  const auto& names = panel.x.categories;
  const double index = std::round(x) - 1.0;
  const bool exists = index >= 0.0 && index < static_cast<double>(names.size());
  return quote(has_category && exists ? names[static_cast<std::size_t>(index)] : "");
}

}  // namespace

std::string make_chart_csv(const Chart& chart) {
  std::vector<Column> columns;
  std::copy_if(kColumns.begin(), kColumns.end(), std::back_inserter(columns),
               [&](const Column& column) { return has_values(chart, column); });
  const bool has_names = has_categories(chart);
  std::string text = has_names ? "panel,series,category" : "panel,series";
  for (const Column& column : columns) text += std::string(",") + column.name;
  text += "\n";
  for (const ChartPanel& panel : chart.panels) {
    for (const ChartSeries& s : panel.series) {
      const std::string begin = quote(name_panel(panel)) + "," + quote(s.name);
      for (std::size_t i = 0; i < s.x.size(); ++i) {
        text += begin;
        if (has_names) text += "," + name_category(panel, s, s.x[i]);
        for (const Column& column : columns) text += "," + print(s.*column.values, i);
        text += "\n";
      }
    }
  }
  return text;
}

}  // namespace strut
