// What the sensors of a kit read in its runs: its true model, with faults, on its true roads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/hidden/car.h"
#include "tests/hidden/faults.h"
#include "tests/hidden/kit.h"
#include "tests/hidden/sensor.h"

namespace strut::hidden {

/// All inputs of a trial's simulation.
struct Truth {
  std::vector<double> factors;  // of the kit's parameters
  std::vector<FaultSetting> faults;
  std::vector<double> speed_error;  // of each run, 1
  double roughness = 0.0;           // m^3 at 0.1 cycles/m; 0: smooth
  std::uint64_t seed = 0;           // of the roughness
  double force_scale = 1.0;         // of the car's masses, inertias, stiffnesses and dampings
  // Small errors of each sensor; empty: none.
  std::vector<double> sensor_gain, sensor_skew;  // 1, s
  // Adjustments of a fit, of each run; empty: none.
  std::vector<double> speed_change;  // 1, on the road of the speeds without it
  std::vector<double> time_shift;    // s, by which the recording begins later
};

/// A truth without faults, errors and roughness.
Truth make_nominal_truth(const Kit& kit);

/// Noise-free channels of run `run`, one signal per sensor on a grid of `rate` [Hz] that begins
/// `margin` [s] before the recording and ends as much after it; sensor faults included.
std::vector<Signal> simulate_run(const Kit& kit, const Truth& truth, std::size_t run, double rate,
                                 double margin);

/// Adds a truth's small errors of sensors to the signals of all sensors of a kit.
void add_sensor_errors(const Truth& truth, std::vector<Signal>& signals);

/// The car of a truth.
Car make_car(const Kit& kit, const Truth& truth);
inline constexpr double kFootprint = 0.12;  // m
/// m, over which the tires of a kit average its roads.
double get_footprint(const Kit& kit);

}  // namespace strut::hidden
