// Charts as data, independent of their drawing. A chart becomes an interactive figure of a page
// (report/plotly.h) and a table of numbers (report/chart_csv.h).
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace strut {

/// Colors that the color-blind can tell apart (M. Okabe, K. Ito, 2008): colors 1 to 6 of a series.
inline constexpr const char* kChartColors[] = {"#0072B2", "#D55E00", "#009E73",
                                               "#CC79A7", "#E69F00", "#56B4E9"};
/// Color number of the page's text.
inline constexpr int kInk = 0;

enum class SeriesKind {
  kLine,
  kDashedLine,
  kPoints,
  kLinePoints,
  kBand,  // between low and high
  kBars,  // height y at x; whiskers from low to high if these are given
  kBoxes  // box plots: quartiles of all y with the same x
};

enum class Marker { kDot, kCircle, kCross, kTriangle };

/// Width of bars at x = 1, 2, ...
inline constexpr double kBarWidth = 0.7;

/// A series of points. A number that is not finite is a gap.
struct ChartSeries {
  std::string name;  // legend entry, shared by all series of this name; "": none
  SeriesKind kind = SeriesKind::kLine;
  int color = 1;
  std::vector<double> x = {}, y = {};
  std::vector<double> low = {}, high = {};
  std::vector<double> value = {};  // colors each point on the panel's color scale
  Marker marker = Marker::kDot;
  double width = 0.0;  // width of bars, in units of x; 0: chosen by plotly.js
};

struct ChartAxis {
  std::string label;
  bool is_logarithmic = false;
  std::vector<std::string> categories = {};  // tick labels at 1, 2, ...
  std::vector<double> range = {};            // minimum, maximum; empty: that of the data
};

struct ChartPanel {
  ChartAxis x, y;
  std::vector<ChartSeries> series;
  std::string title = {};
  std::string value_label = {};  // label of the color scale
  std::string about = {};        // replaces name_panel() where title and labels are not unique
};

/// Panels row by row, `columns` per row, below a common legend.
struct Chart {
  std::string name;  // name of its files
  std::vector<ChartPanel> panels;
  std::size_t columns = 1;
  int panel_height = 320;  // px, including the axis
  int width = 1000;        // px, nominal
  bool shares_x = false;   // all panels zoom together in x
  std::string caption = {};

  std::size_t rows() const { return (panels.size() + columns - 1) / columns; }
  /// Legend entries: the first series of each name.
  std::vector<const ChartSeries*> list_legend() const;
};

/// Frame of a panel in its chart, as fractions of width and height from the lower left.
struct PanelPlace {
  double left, right, bottom, top;
};

/// Height of the chart with its legend, which is at the top [px].
int calc_height(const Chart& chart);
/// The frame of a panel, without labels.
PanelPlace calc_place(const Chart& chart, std::size_t panel);

/// The name of a panel in tables: "states: pitch [rad] over time [s]".
std::string name_panel(const ChartPanel& panel);

/// About as many as a screen is wide [px].
inline constexpr std::size_t kCurvePoints = 1600;

/// Decimates a curve to about `max_points` points: keeps the minimum, the maximum and a gap of each
/// segment, so that no peak is lost.
ChartSeries make_curve(const std::string& name, SeriesKind kind, int color,
                       const std::vector<double>& x, const std::vector<double>& y,
                       std::size_t max_points = kCurvePoints);

/// A name with spaces for underscores: "body_position_z" -> "body position z"
std::string make_words(std::string name);

/// "body position z [m]"
std::string make_label(const std::string& name, const std::string& unit);

}  // namespace strut
