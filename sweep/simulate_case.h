// One car through one maneuver, alone: what `strut simulate` runs.
#pragma once

#include <vector>

#include "sweep/request.h"

namespace strut {

/// Runs a prepared case in plain double on the widest instruction set of this processor, or by
/// CVODE, and reads all channels as their sensors do: the snapshot and, with `interval` [s] above
/// 0, their history. One lane. Whether the run got through is in `status` (0: it did) and
/// `failure_time`.
LaneResults simulate_case(const PreparedCase& c, const SolverOptions& integrate = {},
                          double interval = 0.0);

/// True where the snapshot's line was reached.
bool has_snapshot(const LaneResults& results);

/// One channel of the history of `channels` channels, of one lane.
std::vector<double> get_history(const LaneResults& results, std::size_t channels,
                                std::size_t channel);

}  // namespace strut
