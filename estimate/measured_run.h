// One measured run: readings of some channels over the sensor's own clock, and the
// model as far as it is known, with what drives it.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "estimate/sensor_noise.h"
#include "model/model.h"

namespace strut {

/// One sensor.
struct MeasuredChannel {
  int channel = 0;             // of ModelInfo::channels
  double sigma = 0.0;          // 1 sigma of its white noise per sample, in the channel's unit
  std::vector<double> values;  // one reading per time
};

/// The noise of a recorded input.
struct InputNoise {
  double sigma = 0.0;       // 1 sigma per sample, in the input's unit
  double half_width = 0.0;  // s, of the local cubics that smoothed it; 0: none did
};

struct MeasuredRun {
  std::string name;           // the file, for messages
  Model setup;                // known or supposed; a maneuver's duration is the fit's own
  std::vector<double> times;  // s, ascending
  std::vector<MeasuredChannel> channels;
  bool may_miss = false;                  // readings may be NaN: missing
  std::vector<InputNoise> input_noise{};  // of each recorded input
};

/// Keeps the times in [from, to] s.
void cut_window(MeasuredRun& run, double from, double to);

/// Throws InputError, naming run and place, unless there are channels with a positive sigma, none
/// of them twice, as many readings as times, every number finite (or missing, where it may be), and
/// times that ascend.
void check_measured_run(const MeasuredRun& run);

/// A measurement yet to be made, for bounds: the channels that have a sensor, every 1 / rate s from
/// `from` to `to`, readings zero.
MeasuredRun make_planned_run(const Case& setup, const SensorNoise& noise, double rate, double from,
                             double to);

}  // namespace strut
