// Figures of merit of a ride: comfort by ISO 2631-1, travel, road holding.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "model/car/spec.h"

namespace strut {

/// The acceleration [m/s^2] weighted by W_k of ISO 2631-1:1997, Annex A: vertical, for a seated
/// person. Starts from rest. `rate` in Hz, at least kMinWeightedRate.
std::vector<double> weight_acceleration(const std::vector<double>& acceleration, double rate);

/// Below, the low-pass at 100 Hz would not be what the standard says.
inline constexpr double kMinWeightedRate = 400.0;

struct AxleRide {
  double travel = 0.0;          // m, largest deflection of the suspension from nominal trim
  double load_variation = 0.0;  // rms of a tire's load about its mean, over the mean
  double airborne = 0.0;        // s, with at least one wheel off the road
};

struct Ride {
  double peak = 0.0;  // m/s^2, of the body, vertical
  double rms = 0.0;   // m/s^2
  /// m/s^2, of the acceleration weighted by W_k: root mean square over the run, and the largest
  /// over any second (ISO 2631-1, 6.3.1, maximum transient vibration value), for single bumps.
  std::optional<double> weighted, transient;
  std::array<AxleRide, kAxles> axles;
};

/// Reads a channel of a car, by its number, at all samples.
using ReadChannel = std::function<std::vector<double>(int channel)>;

/// `rate` [Hz]: of the samples. Reads list_ride_channels().
Ride calc_ride(const ReadChannel& read, double rate);
/// The channels that a ride is judged by.
std::vector<int> list_ride_channels();

}  // namespace strut
