// strut identify by a network over windows of time histories.
#pragma once

#include <filesystem>
#include <vector>

#include "io/store/measurement.h"
#include "jobs/cli/arguments.h"
#include "jobs/identify/result.h"
#include "train/model/identifier.h"

namespace strut {

/// A measured time history on the sample times of a model's window.
struct MeasuredRecord {
  std::vector<double> values;  // channel by channel
  std::size_t samples = 0;     // of each
  double begin = 0.0;          // s, time of the first
};

/// Columns `time` and the window's channels of a file, on a grid of the window's interval: as they
/// are where they were sampled so, else by Lagrange's polynomials through the six samples around
/// each instant. A window that is not aligned is cut at its own times. Throws InputError that names
/// the file, and the row where times do not ascend or samples lie too far apart; or where the rate
/// is below the model's, a unit is another, or the record is too short.
MeasuredRecord read_record(const WindowTransform& window, const std::filesystem::path& file);

/// What a record tells. Outside of what the network was trained on are a component beyond its range
/// by more than the noise, a record that the directions of the training do not span, and one that
/// agrees with the reference only at its end.
IdentifiedRow identify_record(const TrainedModel& model, const Identifier& identifier,
                              const MeasuredRecord& record, bool extrapolate);

/// One row for each of `files`. Returns an exit code.
int identify_by_window(const Arguments& arguments, const TrainedModel& model,
                       const std::vector<std::filesystem::path>& files);

}  // namespace strut
