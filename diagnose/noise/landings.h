// Readings of a wheel that lands.
//
// Its acceleration then changes by several g within two milliseconds, by hundreds of a sensor's
// standard deviations in one. A reading depends on the moment of the landing more finely than that
// is known, and not linearly. Such readings are excluded from a fit.
#pragma once

#include <cstddef>
#include <vector>

#include "estimate/measured_run.h"
#include "estimate/unknown.h"

namespace strut {

/// Indices of a reading in MeasuredRun::channels and MeasuredRun::times.
struct LandingReading {
  std::size_t channel = 0, time = 0;
};

/// The readings of wheels' accelerations within 6 ms of the landings of these wheels, in a
/// simulation of run number `number` at `values` of the unknowns. A sensor's own delay is ignored.
/// Empty where the car cannot be simulated.
std::vector<LandingReading> list_landings(const MeasuredRun& run,
                                          const std::vector<Unknown>& unknowns,
                                          const std::vector<double>& values, std::size_t number);

}  // namespace strut
