#include "jobs/report/chart_csv.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "io/config.h"

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
                                             {"z", &ChartSeries::z},
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

std::string name_panel(const ChartPanel& panel) {
  const std::string axes = panel.y.label + " over " + panel.x.label;
  return panel.title.empty() ? axes : panel.title + ": " + axes;
}

}  // namespace

std::string make_chart_csv(const Chart& chart) {
  std::vector<Column> columns;
  std::copy_if(kColumns.begin(), kColumns.end(), std::back_inserter(columns),
               [&](const Column& column) { return has_values(chart, column); });
  std::string text = "panel,series";
  for (const Column& column : columns) text += std::string(",") + column.name;
  text += "\n";
  for (const ChartPanel& panel : chart.panels) {
    for (const ChartSeries& s : panel.series) {
      const std::string begin = quote(name_panel(panel)) + "," + quote(s.name);
      for (std::size_t i = 0; i < s.x.size(); ++i) {
        text += begin;
        for (const Column& column : columns) text += "," + print(s.*column.values, i);
        text += "\n";
      }
    }
  }
  return text;
}

}  // namespace strut
