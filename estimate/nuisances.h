// Unknowns of one run alone: its clock, its speed, its start, the biases of its sensors.
#pragma once

#include <vector>

#include "estimate/unknown.h"

namespace strut {

/// 1 sigma of what is not known about each crossing of a road; 0: known.
struct NuisanceSigmas {
  double hit_time = 0.005;  // s, a trigger at one frame of a 100 Hz bus
  double speed = 0.2;       // m/s, a wheel speed sensor and the tire's effective radius
  SensorNoise bias;         // per CarChannel, in its unit; empty: make_default_bias()
};

/// The nuisances of every run. Of cars on a road: hit time, speed and biases, as far as their sigma
/// is not 0. Of runs that recorded inputs drive: offsets from rest and velocities of the masses at
/// the start, where the first readings are, with priors as wide as the simulated motion; biases
/// with priors as wide as the channel's own spread. What `chosen` has for all runs is left out.
std::vector<Unknown> make_nuisances(const std::vector<MeasuredRun>& runs,
                                    const NuisanceSigmas& sigmas,
                                    const std::vector<Unknown>& chosen = {});

}  // namespace strut
