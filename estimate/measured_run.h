// One measured run: readings of channels over the clock of the measurement, and the model with its
// known or assumed setup and inputs.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/math/local_polynomial.h"
#include "estimate/sensor_noise.h"
#include "io/table/units.h"
#include "model/model.h"

namespace strut {

/// How the numbers of a file's column became readings.
struct ColumnReading {
  double unit = 1.0;   // SI value of the unit in which it was read
  double scale = 1.0;  // by which it was multiplied besides, without its sign
  double delay = 0.0;  // s, by which it was taken to be late

  /// The unit that the column must have where its readings are `factor` times what they should be;
  /// "" if there is none, or if a scale was given, which would act beside it. `si`: of the
  /// readings.
  std::string guess_true_unit(const std::string& si, double factor) const;
};

/// Describes how a column was read. `conversion`: of its cells to SI; `delay`: by how much they are
/// late [s].
ColumnReading make_column_reading(const ColumnConversion& conversion, double delay = 0.0);

/// The readings of one sensor.
struct MeasuredChannel {
  int channel = 0;             // index in ModelInfo::channels
  double sigma = 0.0;          // standard deviation of its white noise, in the channel's unit
  std::vector<double> values;  // one reading per time
  ColumnReading reading{};
};

/// The noise of a recorded input, and its column.
struct InputNoise {
  double sigma = 0.0;  // standard deviation per sample, in the unit of what was recorded
  LocalPolynomial smoothing{};
  int derivative = 0;  // time derivative of the input that was recorded
  ColumnReading reading{};
};

struct MeasuredRun {
  std::string name;           // the file, for messages
  Model setup;                // known or assumed; fits replace a maneuver's duration
  std::vector<double> times;  // s, ascending
  std::vector<MeasuredChannel> channels;
  bool may_miss = false;                  // whether readings may be missing (NaN)
  std::vector<InputNoise> input_noise{};  // by recorded input
};

/// Keeps the readings in [from, to] s.
void cut_window(MeasuredRun& run, double from, double to);

/// Throws InputError, with the run and the sample, unless the run has ascending times and channels,
/// each once, with a positive sigma and one reading per time, all finite (or missing if
/// `may_miss`).
void check_measured_run(const MeasuredRun& run);

/// Makes a planned measurement, for bounds: the channels that have a sensor, every 1 / rate s from
/// `from` to `to`, with readings of zero.
MeasuredRun make_planned_run(const Case& setup, const SensorNoise& noise, double rate, double from,
                             double to);

}  // namespace strut
