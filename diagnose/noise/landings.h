// Readings of a wheel that lands.
//
// Its acceleration then changes by some g within two milliseconds, hundreds of a sensor's standard
// deviations in one: what a reading of it is depends on the landing's moment, which is not known as
// precisely, and not linearly. Such readings do not count.
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

/// The readings of wheels' accelerations within 6 ms of where these wheels land, as a car is
/// simulated that has the `unknowns` of run number `number`. Empty where it cannot be simulated.
std::vector<LandingReading> list_landings(const MeasuredRun& run,
                                          const std::vector<Unknown>& unknowns,
                                          const std::vector<double>& values, std::size_t number);

}  // namespace strut
