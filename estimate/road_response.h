// Responses of a car to small changes of a rough road: one simulation per coefficient of the tracks
// (model/scenario/rough_track.h), from shortly before the front wheels meet it.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "estimate/crossing_batch.h"

namespace strut {

/// Height of a pulse [m]: one coefficient more.
inline constexpr double kRoadPulseHeight = 2e-5;

/// Change of a run's compared channels by one coefficient.
struct RoadPulse {
  std::size_t first = 0;  // sample
  SampledRun change{};    // [MeasuredRun::channels][sample - first]; empty: no wheel meets it
};

struct RoadResponse {
  double interval = 0.0;          // s, between samples
  SampledRun rest{};              // without a pulse
  std::vector<RoadPulse> pulses;  // by coefficient, those of the left track first
  long simulation_count = 0;
};

/// Simulates `setup`, a run's car with its tracks, without the effects of its sensors. Steps are
/// four times as long as a fit's: derivatives by a road need not be exact. `preparer`: of this
/// run. Returns why the run cannot be simulated, "" if it can.
std::string simulate_road_response(const MeasuredRun& run, const Case& setup,
                                   const LinearizeOptions& options, CasePreparer& preparer,
                                   RoadResponse& response);

}  // namespace strut
