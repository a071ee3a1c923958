// Sensors: readings of the truth with data-sheet noise and faults.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/hidden/faults.h"

namespace strut::hidden {

/// One column of a file. Data sheets: docs in README.md of this folder.
struct Sensor {
  std::string channel;       // of the model
  std::string column, unit;  // of the file
  std::string si;            // of the channel
  double unit_scale = 1.0;   // SI of one unit of the file
  double noise = 0.0;        // SI, 1 sigma a sample
  double bias = 0.0;         // SI, 1 sigma over sensors
  double quantum = 0.0;      // SI, of the converter
  double range = 1e30;       // SI, reading saturates at +/- range
  bool input = false;        // drives the model
  bool recorded = true;      // false: simulated, but not written
  // Small errors within the data sheet; 0: none.
  double gain = 0.0, skew = 0.0;  // 1, s: 1 sigma over sensors of relative gain error and delay
  double drift = 0.0, hum = 0.0;  // rms over `noise` of drift as 1/f, and of a line of the mains
};

/// Power spectrum of a sensor's drift over that of white noise with the variance noise^2, at a
/// frequency [Hz] of samples at `rate` [Hz].
double calc_drift_spectrum(const Sensor& sensor, double frequency, double rate);

/// The clock of a file: stamps are exact to a microsecond, the samples are not.
struct Clock {
  double offset = 0.0;  // s, delay of the recording's start
  double drift = 0.0;   // 1, fraction by which the file's second is longer
  double jitter = 0.0;  // s, 1 sigma
};

/// A signal on an even grid of time, cubic between.
struct Signal {
  double begin = 0.0, spacing = 1.0;
  std::vector<double> value;

  double evaluate(double t) const;
};

/// The signal with a fault of its sensor: gain, delay [s], first-order low-pass [s]; kSaturation
/// clips at +/-(1 - magnitude) times the setting's peak. The signal itself for other faults.
Signal distort(const Signal& signal, const FaultSetting& fault);

/// Readings in the file's unit at the even stamps [s]: sampled late and with jitter, biased, noisy,
/// with drift and hum, cut at the range, rounded to the converter's steps.
std::vector<double> read_sensor(const Sensor& sensor, const Signal& signal, const Clock& clock,
                                const std::vector<double>& stamps, double bias, std::uint64_t seed,
                                const std::string& purpose);

}  // namespace strut::hidden
