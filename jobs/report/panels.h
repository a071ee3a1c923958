// A figure of panels, side by side and below each other.
#pragma once

#include <string>
#include <vector>

#include "jobs/report/figure.h"

namespace strut {

struct PanelLine {
  std::string title;                        // "": none
  std::string style;                        // gnuplot's: "lines linetype 2"
  std::vector<std::vector<double>> points;  // x, y
};

struct Panel {
  std::string x_label, y_label;
  std::vector<PanelLine> lines;
};

/// Row by row, `columns` a row. The first panel has the legend.
Figure make_panel_figure(const std::string& name, std::size_t columns,
                         const std::vector<Panel>& panels);

}  // namespace strut
