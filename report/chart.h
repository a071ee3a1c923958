// Charts as data: what is shown, apart from how it is drawn. One chart becomes an interactive
// drawing of a page (report/plotly.h) and a table of numbers (report/chart_csv.h).
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace strut {

/// Colors that the color-blind can tell apart (M. Okabe, K. Ito, 2008): colors 1 to 6 of a series.
inline constexpr const char* kChartColors[] = {"#0072B2", "#D55E00", "#009E73",
                                               "#CC79A7", "#E69F00", "#56B4E9"};
/// The color of the page's text.
inline constexpr int kInk = 0;

enum class SeriesKind {
  kLine,
  kDashedLine,
  kPoints,
  kLinePoints,
  kBand,  // between low and high
  kBars,  // at x of height y, whiskers from low to high where these are given
  kBoxes  // quartiles of y, whose values stand at x
};

enum class Marker { kDot, kCircle, kCross, kTriangle };

/// The width of bars at the places 1, 2, ...
inline constexpr double kBarWidth = 0.7;

/// Numbers that belong together. Not finite ones are gaps.
struct ChartSeries {
  std::string name;  // in the legend, one entry for all series of that name; "": none
  SeriesKind kind = SeriesKind::kLine;
  int color = 1;
  std::vector<double> x = {}, y = {};
  std::vector<double> low = {}, high = {};
  std::vector<double> value = {};  // of points, which it colors by the panel's scale
  Marker marker = Marker::kDot;
  double width = 0.0;  // of bars, in units of x; 0: most of the room between them
};

struct ChartAxis {
  std::string label;
  bool is_logarithmic = false;
  std::vector<std::string> categories = {};  // names of the places 1, 2, ...
  std::vector<double> range = {};            // lowest, highest; empty: as the numbers ask for
};

struct ChartPanel {
  ChartAxis x, y;
  std::vector<ChartSeries> series;
  std::string title = {};
  std::string value_label = {};  // of the scale of the points' values
  std::string about = {};  // for name_panel(), where title and labels are those of other panels too
};

/// Panels row by row, `columns` a row, with one legend above them.
struct Chart {
  std::string name;  // of its files
  std::vector<ChartPanel> panels;
  std::size_t columns = 1;
  int panel_height = 320;  // px, with its axis
  int width = 1000;        // px that it is made for
  bool shares_x = false;   // panels below each other are zoomed together
  std::string caption = {};

  std::size_t rows() const { return (panels.size() + columns - 1) / columns; }
  /// Entries of the legend, each once: the first series of each name.
  std::vector<const ChartSeries*> list_legend() const;
};

/// Where a panel stands in its chart, as shares of width and height from the lower left.
struct PanelPlace {
  double left, right, bottom, top;
};

/// Height of the whole chart [px], the legend's share of it at the top, and each panel's frame
/// without labels.
int calc_height(const Chart& chart);
PanelPlace calc_place(const Chart& chart, std::size_t panel);

/// The name of a panel's numbers in tables: "states: pitch [rad] over time [s]".
std::string name_panel(const ChartPanel& panel);

/// A curve of about `most` points at most: of each stretch its lowest and its highest, so that no
/// peak is lost, and a gap where it holds one.
ChartSeries make_curve(const std::string& name, SeriesKind kind, int color,
                       const std::vector<double>& x, const std::vector<double>& y,
                       std::size_t most = 2500);

/// A name as people write it: "body_position_z" -> "body position z"
std::string make_words(std::string name);

/// "body position z [m]"
std::string make_label(const std::string& name, const std::string& unit);

}  // namespace strut
