// Small errors that every sensor has, in the limits of its data sheet: gain, delay and bias.
//
//   reading = y + gain y - skew dy/dt + bias
//
// y: the channel; gain: relative, skew [s]: delay against the clock of the other channels. Linear
// in all three, which is enough for gains of per mille and delays of microseconds; larger errors
// are the effects sensor_gain and sensor_delay.
#pragma once

#include <span>
#include <vector>

#include "estimate/unknown.h"

namespace strut {

struct SensorError {
  double gain = 0.0;
  double skew = 0.0;  // s
  double bias = 0.0;  // in the channel's unit

  bool is_zero() const { return gain == 0.0 && skew == 0.0 && bias == 0.0; }
};

/// Prior standard deviations of gain and skew; 0: none.
struct SensorTolerance {
  double gain = 0.0;
  double skew = 0.0;  // s
};

/// The errors of a channel (index in ModelInfo::channels) in run number `run`.
SensorError collect_sensor_error(const std::vector<Unknown>& unknowns,
                                 const std::vector<double>& values, std::size_t run, int channel);

/// Adds the error to a channel's values at increasing times [s]. Values that are not finite stay.
void add_sensor_error(const SensorError& error, std::span<const double> times,
                      std::span<double> values);

/// Derivatives of a channel's readings by an error of its sensor (is_sensor_error): 1 by its bias,
/// y by its gain, -dy/dt by its skew. dy/dt: parabolas through three samples at their own,
/// increasing times, lines at the ends; error h^2 y''' / 6 inside; 0 where a sample is not finite
/// or alone.
std::vector<double> calc_error_slopes(UnknownKind kind, std::span<const double> times,
                                      std::span<const double> values);

}  // namespace strut
