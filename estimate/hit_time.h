// Hit times of cars that cross a road: simulated time less the time of the measuring clock.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "estimate/crossing_batch.h"
#include "estimate/reading_model.h"
#include "estimate/sampled_curve.h"

namespace strut {

/// The index of the run's hit time, or kNoUnknown.
std::size_t find_hit_time(const std::vector<Unknown>& unknowns, std::size_t run);

/// The run's hit time [s]; 0 where it is not an unknown.
double get_hit_time(const std::vector<Unknown>& unknowns, const std::vector<double>& values,
                    std::size_t run);

/// A reading of a simulated run, and its slope in time; `step` s between samples.
CurvePoint read_curve(const MeasuredRun& run, const SampledRun& sampled, const ReadingPlace& place,
                      double hit_time, double step);

/// Returns the hit time within its bounds that minimizes chi2 of `base`, shifted in time and with
/// the best bias of each channel, on a grid of 1 ms from `start`. A search that starts a flank of
/// the bump away from the truth can end in another local minimum; trying all hit times costs no
/// simulation. Requires that the run has a hit time. `readings`: those of this run.
double find_best_hit_time(const std::vector<Unknown>& unknowns, const MeasuredRun& run,
                          std::span<const ReadingPlace> readings, const SampledRun& base,
                          double start, double step);

}  // namespace strut
