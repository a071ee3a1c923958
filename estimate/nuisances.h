// Unknowns of a single run: its clock, its speed, its initial state, the biases of its sensors.
#pragma once

#include <vector>

#include "estimate/unknown.h"

namespace strut {

/// The parameter that is a nuisance of each run on a road.
inline constexpr char kSpeedName[] = "speed";

/// Prior standard deviations of the nuisances of a crossing of a road; 0: known.
struct NuisanceSigmas {
  double hit_time = 0.005;  // s, a trigger at one frame of a 100 Hz bus
  double speed = 0.2;       // m/s, a wheel speed sensor and the tire's effective radius
  SensorNoise bias;         // per CarChannel, in its unit; empty: make_default_bias()
};

/// Lists the nuisances of every run, except those in `chosen`. A car on a road has a hit time, a
/// speed and biases where their sigma is not 0. A run that recorded inputs drive has initial
/// positions and velocities of its masses, with priors at the first readings and as wide as the
/// simulated motion, and biases with priors as wide as the channel's own spread.
std::vector<Unknown> make_nuisances(const std::vector<MeasuredRun>& runs,
                                    const NuisanceSigmas& sigmas,
                                    const std::vector<Unknown>& chosen = {});

}  // namespace strut
