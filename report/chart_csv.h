// A chart's numbers as a table.
#pragma once

#include <string>

#include "report/chart.h"

namespace strut {

/// One line a point: panel, series, x, y and, where the chart has them, z, low, high. A panel is
/// called by its title or its axes. Numbers read back as the same doubles; what is not there is
/// empty.
std::string make_chart_csv(const Chart& chart);

}  // namespace strut
