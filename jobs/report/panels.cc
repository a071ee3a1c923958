#include "jobs/report/panels.h"

#include <algorithm>

namespace strut {
namespace {

constexpr int kPanelWidth = 330, kPanelHeight = 260, kAxisHeight = 60;  // px
constexpr int kNarrowest = 1000, kLowest = 420;

std::string make_panel(const Panel& panel, const std::string& block) {
  std::string data, plot;
  for (std::size_t i = 0; i < panel.lines.size(); ++i) {
    const PanelLine& line = panel.lines[i];
    const std::string name = block + "_" + std::to_string(i);
    // gnuplot refuses a block without points.
    data += make_data(
        name, line.points.empty() ? std::vector<std::vector<double>>{{0.0, 0.0}} : line.points);
    plot += (i == 0 ? "plot $" : ", $") + name + " using 1:2 with " + line.style +
            (line.title.empty() ? " notitle" : " title " + quote_figure_text(line.title));
  }
  return data + "set xlabel " + quote_figure_text(panel.x_label) + "\nset ylabel " +
         quote_figure_text(panel.y_label) + "\n" + plot + "\nunset key\n";
}

}  // namespace

Figure make_panel_figure(const std::string& name, std::size_t columns,
                         const std::vector<Panel>& panels) {
  const std::size_t rows = (panels.size() + columns - 1) / columns;
  Figure figure{name, std::max(kNarrowest, kPanelWidth * static_cast<int>(columns)),
                rows == 1 ? kLowest : kPanelHeight * static_cast<int>(rows) + kAxisHeight, ""};
  std::string& text = figure.commands;
  text = "set multiplot layout " + std::to_string(rows) + "," + std::to_string(columns) +
         " margins 0.13,0.97,0.14,0.94 spacing 0.09,0.14\nset grid\nset xzeroaxis\n"
         "set key at screen 0.5,0.995 center top horizontal maxrows 1\n"
         "set xlabel font ',12'\nset ylabel font ',12'\n"
         "set tics font ',10'\nset xtics rotate by -35\n";
  for (std::size_t k = 0; k < panels.size(); ++k) {
    text += make_panel(panels[k], "panel" + std::to_string(k));
  }
  text += "unset multiplot\n";
  return figure;
}

}  // namespace strut
