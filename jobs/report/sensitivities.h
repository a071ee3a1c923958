// Sensitivities of a sweep's snapshot to its parameters, and the positions along the road that
// would be more informative: a part of a sweep's report, printed in full by `strut design`.
#pragma once

#include "report/figures.h"
#include "sweep/request.h"

namespace strut {

/// Simulates a few runs around the middle of the grid; noise of the default sensors. If that is
/// impossible for the request, the section says so.
ReportSection make_sensitivity_section(const SweepRequest& request, const FigureDrawer& drawer);

}  // namespace strut
