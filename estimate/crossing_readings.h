// Measured readings of cars that cross a road, against their simulation.
//
//   residual = (y_sim(t + t0; p) + b - y_measured) / sigma
//
// p: parameters and force maps; t0: hit time; b: bias of a sensor.
#pragma once

#include <memory>
#include <vector>

#include "estimate/linearize_options.h"
#include "estimate/reading_model.h"

namespace strut {

/// Simulates as long as the readings need, at most the maneuver's duration; leaves out readings
/// that would be outside of the simulated time for some hit time within its bounds. align() sets
/// the hit time of each run to that of the best fit, by one simulation per run. Throws InputError
/// for unusable runs or unknowns.
std::unique_ptr<ReadingModel> make_crossing_readings(std::vector<MeasuredRun> runs,
                                                     std::vector<Unknown> unknowns,
                                                     const LinearizeOptions& options);

}  // namespace strut
