// A chart's numbers as a table.
#pragma once

#include <string>

#include "report/chart.h"

namespace strut {

/// One line per point: panel (name_panel), series, category, x, y, value, low, high; columns that
/// the chart does not use are left out. Numbers read back as the same doubles; missing ones are
/// empty.
std::string make_chart_csv(const Chart& chart);

}  // namespace strut
