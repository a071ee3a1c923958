// The section of a sweep's report on the histories that its cases recorded.
#pragma once

#include "report/figures.h"
#include "report/html.h"
#include "sweep/folder.h"

namespace strut {

/// Every channel of the histories over time: median and 5 to 95 % of up to 1,000 finished cases, of
/// shards spread evenly over the sweep.
ReportSection make_history_section(const SweepFolder& folder, const FigureDrawer& drawer);

}  // namespace strut
