// The force map of a diagnosis as a figure and as a table.
#pragma once

#include <vector>

#include "diagnose/decide/diagnosis.h"
#include "io/format/csv.h"
#include "report/chart.h"

namespace strut {

/// Force over velocity at three deflections and over deflection at three velocities, as far as the
/// strut was near both in the runs for fitting; and where it was.
Chart make_force_map_chart(const UnknownForce& force);

/// deflection, velocity, force, 1 sigma of it, and how many samples of the runs for fitting lie
/// around: a row a point of an even grid over all that was visited, the velocities of one
/// deflection behind each other.
std::vector<CsvColumn> make_force_map_columns(const UnknownForce& force, const WhitenedFit& fit);

}  // namespace strut
