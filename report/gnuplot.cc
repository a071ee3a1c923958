#include "report/gnuplot.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error/input_error.h"
#include "base/text/format_number.h"
#include "base/text/range.h"
#include "io/file/run_child.h"

namespace strut {
namespace {

constexpr const char* kMissing =
    "gnuplot: cannot be started; pictures need it (Debian: apt install gnuplot-nox)";

/// In single quotes gnuplot replaces nothing: no backticks, no macros. A line's end would end the
/// text, and what follows would be a command. A quote in it is written as the typographic one:
/// gnuplot reads a doubled one as the end where the text begins with it.
std::string quote(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) {
    const bool is_control = static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
    quoted += c == '\'' ? std::string("\u2019") : std::string(1, is_control ? ' ' : c);
  }
  return quoted + "' noenhanced";
}

std::string make_head(const Chart& chart) {
  std::string text = "set terminal svg size " + std::to_string(chart.width) + "," +
                     std::to_string(calc_height(chart)) +
                     " font \"Arial,13\" background \"white\"\nset encoding utf8\n";
  int type = 0;
  for (const char* color : kChartColors) {
    text += "set linetype " + std::to_string(++type) + " linecolor rgb \"" + color +
            "\" linewidth 1.5\n";
  }
  return text +
         "set border linewidth 0.8\nset tics nomirror font ',11'\nset style fill solid 0.6 border\n"
         "set style boxplot outliers pointtype 6\nset multiplot\n";
}

/// The numbers of a series by rows, as its kind needs them.
std::vector<const std::vector<double>*> list_columns(const ChartSeries& s) {
  switch (s.kind) {
    case SeriesKind::kBand:
      return {&s.x, &s.low, &s.high};
    case SeriesKind::kBars:
      if (s.low.empty()) return {&s.x, &s.y};
      return {&s.x, &s.y, &s.low, &s.high};
    case SeriesKind::kPoints3d:
      return {&s.x, &s.y, &s.z};
    default:
      return {&s.x, &s.y};
  }
}

std::string print(double value) { return std::isfinite(value) ? format_number(value) : "NaN"; }

/// A block of data, `$name`. gnuplot refuses one without points.
std::string make_block(const std::string& name, const ChartSeries& s) {
  const auto columns = list_columns(s);
  std::string text = "$" + name + " << END\n";
  for (std::size_t i = 0; i < s.x.size(); ++i) {
    for (const std::vector<double>* column : columns) {
      text += (column == columns.front() ? "" : " ") + print((*column)[i]);
    }
    text += "\n";
  }
  return text + (s.x.empty() ? "NaN NaN NaN NaN\n" : "") + "END\n";
}

std::string get_color(int color) {
  return color == kInk ? "linecolor rgb 'black'" : "linetype " + std::to_string(color);
}

std::string get_marker(const ChartSeries& s) {
  constexpr std::size_t kMany = 400;  // beyond, smaller ones
  switch (s.marker) {
    case Marker::kCircle:
      return " pointtype 6 pointsize 0.8";
    case Marker::kCross:
      return " pointtype 2 pointsize 0.7";
    case Marker::kTriangle:
      return " pointtype 9 pointsize 1.1";
    case Marker::kDot:
      break;
  }
  return s.x.size() > kMany ? " pointtype 7 pointsize 0.2" : " pointtype 7 pointsize 0.5";
}

/// Bars fill most of the room between them.
double calc_width(const ChartSeries& s) {
  constexpr double kShare = 0.7;
  if (s.width > 0.0) return s.width;
  double room = s.x.size() > 1 ? std::numeric_limits<double>::infinity() : 1.0;
  for (std::size_t i = 1; i < s.x.size(); ++i) room = std::min(room, std::abs(s.x[i] - s.x[i - 1]));
  return kShare * room;
}

/// What follows the data in a plot command.
std::string make_style(const ChartSeries& s) {
  const std::string color = " " + get_color(s.color);
  switch (s.kind) {
    case SeriesKind::kLine:
      return " using 1:2 with lines" + color;
    case SeriesKind::kDashedLine:
      return " using 1:2 with lines" + color + " dashtype 2";
    case SeriesKind::kLinePoints:
      return " using 1:2 with linespoints" + color + get_marker(s);
    case SeriesKind::kPoints:
      return " using 1:2 with points" + color + get_marker(s);
    case SeriesKind::kBand:
      return " using 1:2:3 with filledcurves" + color + " fillstyle solid 0.3 noborder";
    case SeriesKind::kBars:
      return (s.low.empty() ? " using 1:2:(" : " using 1:2:3:4:(") + print(calc_width(s)) +
             (s.low.empty() ? ") with boxes" : ") with boxerrorbars") + color;
    case SeriesKind::kBoxes:
      return " using (" + print(s.x.empty() ? 0.0 : s.x.front()) + "):2:(0.4) with boxplot" +
             color + " pointsize 0.4";
    case SeriesKind::kPoints3d:
      return " using 1:2:3 with points" + color + get_marker(s);
  }
  return "";
}

std::string make_axis(const std::string& axis, const ChartAxis& about) {
  std::string text = "set " + axis + "label " + quote(about.label) + "\n";
  text += (about.is_logarithmic ? "set logscale " : "unset logscale ") + axis + "\nset format " +
          axis + (about.is_logarithmic ? " '10^{%L}'" : " '%.6g'") + "\n";
  text += "set " + axis + "range [" +
          (about.range.empty() ? "*:*" : print(about.range[0]) + ":" + print(about.range[1])) +
          "]\nset " + axis + "tics autofreq norotate\n";
  if (about.categories.empty()) return text;
  std::string tics;
  for (std::size_t c = 0; c < about.categories.size(); ++c) {
    std::string name = quote(about.categories[c]);
    name.erase(name.rfind(" noenhanced"));
    tics += (c == 0 ? "" : ", ") + name + " " + std::to_string(c + 1);
  }
  return text + "set " + axis + "tics rotate by -35 (" + tics + ")\n";
}

std::string make_margins(const PanelPlace& place) {
  return "set lmargin at screen " + format_number(place.left) + "\nset rmargin at screen " +
         format_number(place.right) + "\nset bmargin at screen " + format_number(place.bottom) +
         "\nset tmargin at screen " + format_number(place.top) + "\n";
}

/// The names of the series above all panels: a plot of nothing, as wide as the chart.
std::string make_legend(const Chart& chart) {
  const auto entries = chart.list_legend();
  if (entries.empty()) return "";
  std::string plot;
  for (const ChartSeries* s : entries) {
    std::string style = make_style(*s);
    style.erase(0, style.find(" with "));
    if (s->kind == SeriesKind::kBoxes || s->kind == SeriesKind::kBars) {
      style = " with boxes " + get_color(s->color);
    }
    plot += (plot.empty() ? "NaN" : ", NaN") + style + " title " + quote(s->name);
  }
  const double bottom = calc_place(chart, 0).top;
  return make_margins({0.02, 0.98, bottom, 0.995}) +
         "unset border\nunset tics\nset key center top horizontal Left reverse samplen 2\n"
         "plot [1:2] [1:2] " +
         plot + "\nset border 31 linewidth 0.8\nset tics nomirror\n";
}

/// Tics of three-dimensional axes stand one behind the other: only lowest, middle, highest.
std::string make_three_tics(const ChartPanel& panel, const char* axis,
                            std::vector<double> ChartSeries::*values) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const ChartSeries& s : panel.series) {
    for (const double value : s.*values) {
      if (!std::isfinite(value)) continue;
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  if (!(high > low)) return "";
  return std::string("set ") + axis + "tics " + print(low) + ", " + print(0.5 * (high - low)) +
         "\n";
}

std::string make_depth(const ChartPanel& panel) {
  return make_axis("z", panel.z) + make_three_tics(panel, "x", &ChartSeries::x) +
         make_three_tics(panel, "y", &ChartSeries::y) +
         make_three_tics(panel, "z", &ChartSeries::z) +
         "set format z '%.4g'\nset xlabel rotate parallel offset 0,-0.5\nset ylabel rotate "
         "parallel "
         "offset -1,0\nset zlabel rotate by 90 offset 0,0\nset view 62,35,0.75,0.9\n"
         "set ticslevel 0.05\n";
}

bool has_place(const ChartAxis& axis, double value) {
  return std::isfinite(value) && (!axis.is_logarithmic || value > 0.0);
}

/// Whether a panel shows anything: gnuplot finds no range for nothing.
bool has_points(const ChartPanel& panel) {
  return std::any_of(panel.series.begin(), panel.series.end(), [&](const ChartSeries& s) {
    const std::vector<double>& values = s.kind == SeriesKind::kBand ? s.low : s.y;
    for (std::size_t i = 0; i < s.x.size(); ++i) {
      if (has_place(panel.x, s.x[i]) && has_place(panel.y, values[i])) return true;
    }
    return false;
  });
}

std::string make_panel(const Chart& chart, std::size_t p, bool is_3d) {
  const ChartPanel& panel = chart.panels[p];
  std::string text, plot;
  for (std::size_t i = 0; i < panel.series.size(); ++i) {
    const std::string name = "panel" + std::to_string(p) + "_" + std::to_string(i);
    text += make_block(name, panel.series[i]);
    plot += (i == 0 ? "$" : ", $") + name + make_style(panel.series[i]) + " notitle";
  }
  text += make_margins(calc_place(chart, p)) + "unset key\nset grid\nset title " +
          quote(panel.title) + "\n" + make_axis("x", panel.x) + make_axis("y", panel.y);
  if (is_3d) text += make_depth(panel);
  if (!has_points(panel)) text += "set xrange [1:2]\nset yrange [1:2]\nset zrange [1:2]\n";
  return text + (is_3d ? "splot " : "plot ") + (plot.empty() ? "NaN notitle" : plot) + "\n";
}

}  // namespace

std::string make_gnuplot(const Chart& chart) {
  std::string text = make_head(chart) + make_legend(chart);
  for (std::size_t p = 0; p < chart.panels.size(); ++p) {
    text += make_panel(chart, p, chart.is_3d());
  }
  return text + "unset multiplot\n";
}

bool has_gnuplot() { return read_child({"gnuplot", "--version"}).code == 0; }

std::string draw_picture(const std::string& name, const std::string& script) {
  ChildOptions options;
  options.patience = std::chrono::minutes(10);  // of a crowded machine
  options.input = script;
  options.hidden_variables = {"GNUPLOT"};
  // Not by the user's own settings.
  const ChildOutput output = read_child({"gnuplot", "-d", "-"}, options);
  if (output.code == ChildOutput::kNotStarted) throw EnvironmentError(kMissing);
  if (output.code != 0 || output.out.empty()) {
    throw EnvironmentError("picture " + name + ": gnuplot failed: " + output.explain());
  }
  return output.out;
}

}  // namespace strut
