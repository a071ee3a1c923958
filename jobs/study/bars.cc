#include "jobs/study/bars.h"

#include <algorithm>
#include <cmath>

#include "io/config.h"

namespace strut {
namespace {

using Rows = std::vector<std::vector<double>>;

/// Bars of the mean absolute error, one panel a parameter.
struct Bars {
  std::string name, caption;
  std::vector<const CellResult*> cells;
  std::vector<std::string> labels;
  std::vector<int> colors;  // line types
};

std::string make_panel(const StudyRequest& request, const Bars& bars, std::size_t p) {
  Rows ours, published;
  double lowest = 1e300, highest = 0.0;
  for (std::size_t b = 0; b < bars.cells.size(); ++b) {
    const CellResult& cell = *bars.cells[b];
    const Spread& mae = cell.spread[p][kMae];
    const double x = static_cast<double>(b + 1);
    const double theirs = find_published(request, cell, p, kMae);
    ours.push_back({x, mae.median, mae.low, mae.high, static_cast<double>(bars.colors[b])});
    published.push_back({x, theirs});
    lowest = std::min(lowest, mae.low);
    highest = std::max({highest, mae.high, std::isnan(theirs) ? 0.0 : theirs});
  }
  const ColumnInfo& parameter = bars.cells.front()->parameters[p];
  const std::string block = std::to_string(p);
  // A bar of a logarithmic scale has no zero: it stands on the decade below the smallest.
  const double floor = std::pow(10.0, std::floor(std::log10(std::max(lowest, 1e-12) * 0.5)));
  return make_data("ours" + block, ours) + make_data("published" + block, published) +
         "set title " + quote_figure_text(make_words(parameter.name)) + "\nset ylabel " +
         quote_figure_text("MAE [" + parameter.unit + "]") + "\nset yrange [" +
         format_number(floor) + ":" + format_number(highest * 3.0) + "]\nplot $ours" + block +
         " using 1:2:3:4:(0.7):5 with boxerrorbars linecolor variable notitle, $published" + block +
         " using 1:2 with points linetype 2 linecolor rgb 'black' pointtype 9 pointsize 1.1 "
         "notitle\n";
}

StudyFigure draw_bars(const StudyRequest& request, const Bars& bars) {
  const std::size_t count = bars.cells.front()->parameters.size(), rows = (count + 1) / 2;
  StudyFigure figure{{bars.name, 1000, static_cast<int>(360 * rows), ""}, bars.caption};
  std::string& text = figure.figure.commands;
  std::string tics;
  for (std::size_t b = 0; b < bars.labels.size(); ++b) {
    tics += (b == 0 ? "'" : ", '") + bars.labels[b] + "' " + std::to_string(b + 1);
  }
  text = "set multiplot layout " + std::to_string(rows) +
         ",2\nset logscale y\nset format y '10^{%L}'\nset grid ytics\n"
         "set style fill solid 0.6 border\nset xrange [0.3:" +
         std::to_string(bars.cells.size()) +
         ".7]\nset xtics rotate by -35 font ',11'\nset xtics (" + tics + ")\n";
  for (std::size_t p = 0; p < count; ++p) text += make_panel(request, bars, p);
  text += "unset multiplot\n";
  return figure;
}

constexpr char kBarsNote[] =
    " Bars: median over the seeds, with the smallest and the largest; triangles: the paper's. The "
    "scale is logarithmic.";

Bars make_network_bars(const StudyRequest& request, const StudyResults& results,
                       std::size_t preload) {
  Bars bars;
  bars.name = "networks_" + request.preloads[preload].name;
  bars.caption = std::string(
                     "As Figure 8 of the paper. Mean absolute errors of all networks and "
                     "numbers of cases.") +
                 kBarsNote;
  for (const CellResult& cell : results.cells) {
    const StudyCell& c = cell.cell;
    if (c.preload != preload || c.inputs != request.main_inputs || c.best_instant) continue;
    bars.cells.push_back(&cell);
    bars.labels.push_back(request.networks[c.network].name + " " +
                          std::to_string(request.samples[c.samples]));
    bars.colors.push_back(1 + static_cast<int>(c.samples % 3) * 2);
  }
  return bars;
}

Bars make_input_bars(const StudyRequest& request, const StudyResults& results,
                     std::size_t preload) {
  Bars bars;
  bars.name = "inputs_" + request.preloads[preload].name;
  bars.caption = std::string(
                     "As Figure 9 of the paper. Mean absolute errors with different inputs "
                     "and instants.") +
                 kBarsNote;
  for (const CellResult& cell : results.cells) {
    const StudyCell& c = cell.cell;
    const bool here = c.preload == preload && c.samples == request.main_samples &&
                      c.network == request.main_network;
    if (!here) continue;
    bars.cells.push_back(&cell);
    bars.labels.push_back(request.inputs[c.inputs].name + (c.best_instant ? ", best" : ""));
    bars.colors.push_back(c.best_instant ? 3 : 1);
  }
  return bars;
}

}  // namespace

std::vector<StudyFigure> make_bar_figures(const StudyRequest& request, const StudyResults& results,
                                          std::size_t preload) {
  std::vector<StudyFigure> figures;
  for (const auto& make : {make_network_bars, make_input_bars}) {
    const Bars bars = make(request, results, preload);
    if (bars.cells.size() > 1) figures.push_back(draw_bars(request, bars));
  }
  return figures;
}

}  // namespace strut
