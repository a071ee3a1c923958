// Resamples a measured time history to the sample times of a model's window.
#pragma once

#include <filesystem>
#include <vector>

#include "io/store/column_map.h"
#include "train/data/transform.h"

namespace strut {

struct MeasuredRecord {
  std::vector<double> values;  // channel by channel
  std::size_t samples = 0;     // per channel
  double begin = 0.0;          // s, time of the first sample
};

/// Reads the column `time` and the window's channels of a file onto a grid of the window's
/// interval: unchanged if they were sampled on it, otherwise by Lagrange polynomials through the
/// six samples around each instant. A window that is not aligned is cut at its own times. Throws
/// InputError that names the file, and the row where times do not ascend or samples lie too far
/// apart; also where the rate is below the model's, a unit differs, or the record is too short.
MeasuredRecord read_record(const WindowTransform& window, const std::filesystem::path& file,
                           const ColumnMap& map = {});

}  // namespace strut
