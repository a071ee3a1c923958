#include "jobs/study/noise_figure.h"

#include <iterator>

#include "io/config.h"

namespace strut {
namespace {

// px; a panel with its title and its x axis' text
constexpr int kPanelHeight = 425, kTitleHeight = 35, kTextHeight = 85, kKeyHeight = 110;

/// What is drawn of each point: a column of the panel's data, and gnuplot's words for it.
struct Curve {
  std::string label, style;
  std::vector<double> values;
};

/// One value a point.
template <class Get>
std::vector<double> list_values(const NoiseStudy& study, std::size_t p, const Get& get) {
  std::vector<double> values;
  values.reserve(study.points.size());
  for (const NoisePoint& point : study.points) values.push_back(get(point.errors[p]));
  return values;
}

std::string make_line_style(int color) {
  return "with linespoints linetype " + std::to_string(color) + " linewidth 2 pointtype 0";
}

std::string make_point_style(int color, int shape) {
  return "with points linetype " + std::to_string(color) + " pointsize 1.1 pointtype " +
         std::to_string(shape);
}

constexpr int kCircle = 7, kTriangle = 9;  // gnuplot's point types

std::vector<Curve> list_curves(const NoiseStudy& study, std::size_t p) {
  std::vector<Curve> curves;
  const int window = static_cast<int>(std::size(kFigureColors) / 2);
  for (std::size_t i = 0; i < study.preloads.size(); ++i) {
    const int color = static_cast<int>(i) + 1;
    const std::string label = "snapshot, " + make_words(study.preloads[i]);
    curves.push_back({label + ": bound", make_line_style(color),
                      list_values(study, p, [i](const auto& e) { return e.snapshots[i].bound; })});
    curves.push_back(
        {label + ": network", make_point_style(color, kCircle),
         list_values(study, p, [i](const auto& e) { return e.snapshots[i].network; })});
  }
  curves.push_back({"window: bound", make_line_style(window),
                    list_values(study, p, [](const auto& e) { return e.window.bound; })});
  curves.push_back({"window: network", make_point_style(window, kCircle),
                    list_values(study, p, [](const auto& e) { return e.window.network; })});
  curves.push_back({"window: fit", make_point_style(window, kTriangle),
                    list_values(study, p, [](const auto& e) { return e.window.fit; })});
  curves.push_back({"spread of the grid",
                    "with lines linecolor rgb 'black' linewidth 1.5 dashtype 2",
                    std::vector<double>(study.points.size(), study.spread[p])});
  return curves;
}

/// A data block: scale, then the curves.
std::string make_block(const NoiseStudy& study, const std::vector<Curve>& curves,
                       const std::string& name) {
  std::vector<std::vector<double>> rows;
  rows.reserve(study.points.size());
  for (std::size_t i = 0; i < study.points.size(); ++i) {
    std::vector<double> row = {study.points[i].scale};
    for (const Curve& curve : curves) row.push_back(curve.values[i]);
    rows.push_back(std::move(row));
  }
  return make_data(name, rows);
}

std::string make_margins(double left, double right, double bottom, double top) {
  return "set lmargin at screen " + format_number(left) + "\nset rmargin at screen " +
         format_number(right) + "\nset bmargin at screen " + format_number(bottom) +
         "\nset tmargin at screen " + format_number(top) + "\n";
}

/// The names of the curves above all panels: a plot of nothing, as wide as the figure.
std::string make_key(const std::vector<Curve>& curves, double bottom) {
  std::string text = make_margins(0.05, 0.98, bottom, 0.995) +
                     "unset border\nunset xtics\nunset ytics\nset key center center horizontal "
                     "Left reverse samplen 2\nplot [1:2] [1:2] ";
  for (const Curve& curve : curves) {
    text += (&curve == curves.data() ? "NaN " : ", NaN ") + curve.style + " title " +
            quote_figure_text(curve.label);
  }
  return text +
         "\nunset key\nset border 31 linewidth 0.8\nset xtics nomirror\nset ytics nomirror\n";
}

std::string make_panel(const NoiseStudy& study, std::size_t p) {
  const std::vector<Curve> curves = list_curves(study, p);
  const std::string block = "noise" + std::to_string(p);
  const ColumnInfo& parameter = study.parameters[p];
  std::string text = make_block(study, curves, block) + "set title " +
                     quote_figure_text(make_words(parameter.name)) + "\nset ylabel " +
                     quote_figure_text("error [" + parameter.unit + "]") + "\nplot ";
  for (std::size_t c = 0; c < curves.size(); ++c) {
    text += (c == 0 ? "$" : ", $") + block + " using 1:" + std::to_string(c + 2) + " " +
            curves[c].style + " notitle";
  }
  return text + "\n";
}

}  // namespace

StudyFigure make_noise_figure(const NoiseStudy& study) {
  const std::size_t count = study.parameters.size(), rows = (count + 1) / 2;
  const int height = kKeyHeight + kPanelHeight * static_cast<int>(rows);
  const auto share = [height](int pixels) { return static_cast<double>(pixels) / height; };
  StudyFigure figure{{"noise", 1000, height, ""}, ""};
  const double low = study.points.front().scale, high = study.points.back().scale;
  figure.figure.commands = "set multiplot\n" +
                           make_key(list_curves(study, 0), 1.0 - share(kKeyHeight)) +
                           "set logscale xy\nset format x '%g'\nset format y '10^{%L}'\nset grid\n"
                           "set xrange [" +
                           format_number(low / 1.3) + ":" + format_number(high * 1.3) +
                           "]\nset xlabel 'noise; 1: real sensors'\n";
  for (std::size_t p = 0; p < count; ++p) {
    const double left = p % 2 == 0 ? 0.09 : 0.6;
    const double top = 1.0 - share(kKeyHeight + kPanelHeight * static_cast<int>(p / 2));
    figure.figure.commands +=
        make_margins(left, left + 0.38, top - share(kPanelHeight - kTextHeight),
                     top - share(kTitleHeight)) +
        make_panel(study, p);
  }
  figure.figure.commands += "unset multiplot\n";
  figure.caption =
      "Root mean square errors over the noise, on cases that training never saw. Lines: "
      "Cramer-Rao bounds; circles: networks; triangles: fits of the simulation; dashed: the error "
      "of who says the middle of the grid always.";
  return figure;
}

}  // namespace strut
