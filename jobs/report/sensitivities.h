// What a sweep's snapshot can tell about its parameters, and where along the way more is told: the
// part of a sweep's report that `strut design` prints in full.
#pragma once

#include "report/figures.h"
#include "sweep/request.h"

namespace strut {

/// Simulates a few runs around the middle of the grid; noise of the default sensors. If that is
/// impossible for the request, the section says so.
ReportSection make_sensitivity_section(const SweepRequest& request, const FigureDrawer& drawer);

}  // namespace strut
