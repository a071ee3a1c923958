// The force map of a diagnosis as a figure and as a table.
#pragma once

#include <vector>

#include "diagnose/decide/diagnosis.h"
#include "io/table/csv.h"
#include "report/chart.h"

namespace strut {

/// Force over velocity at three deflections and over deflection at three velocities, near the
/// states visited in the runs for fitting; and those states.
Chart make_force_map_chart(const UnknownForce& force);

/// Columns deflection, velocity, force, its standard error, and the number of samples of the runs
/// for fitting near the point: one row per point of an even grid over the visited range, velocity
/// fastest.
std::vector<CsvColumn> make_force_map_columns(const UnknownForce& force, const WhitenedFit& fit);

}  // namespace strut
