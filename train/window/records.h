// Noise-free records of a dataset's cases, and noisy records drawn from them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "io/file/row_store.h"
#include "io/store/dataset.h"
#include "train/data/dataset_source.h"
#include "train/data/transform.h"

namespace strut {

/// The window of the histories that a network sees.
struct WindowChoice {
  double from = 0.0, to = 0.0;  // s, on the time axis of the simulations
  /// Maximum shift of a record to agree with the reference, either way [s]; 0: not aligned. 50 ms
  /// cover 6 sigma of a hit time of sigma 5 ms, and 2.5 % of speed change over 10 m at 20 m/s.
  double reach = 0.05;
  /// Maximum number of directions, the inputs of the network.
  int components = 24;
};

struct WindowRecords {
  std::vector<ColumnInfo> channels, targets;
  WindowGrid grid;
  std::size_t spare = 0;  // samples beyond the record, on each side, for drawn hit times
  RowStore rows{1};       // channel by channel, then the targets
  std::int64_t skipped = 0;

  std::size_t samples() const { return grid.record_samples() + 2 * spare; }
};

/// Places the window on the samples of a dataset's histories. Throws InputError if the histories
/// have no room for it, the margins for aligning and `spare` samples on each side.
WindowGrid make_window_grid(const ShardSchema& schema, const WindowChoice& choice,
                            std::size_t spare);

/// Number of samples that the hit times of `noise` need on each side.
std::size_t count_spare(const ShardSchema& schema, const NoiseModel& noise);

/// Reads the histories of the usable cases in one pass; choice.inputs: history channels. Throws
/// InputError as read_usable_rows does, and if the dataset has no histories; CheckError if it was
/// opened without them.
WindowRecords read_window_records(Dataset& dataset, const RowChoice& choice, const WindowGrid& grid,
                                  std::size_t spare, const RowStoreOptions& store);

/// Writes the record of `row` (one of records.rows) with the hit time of a draw and, unless
/// `noise_free`, its biases and noise. `record`: room for grid.record_samples() of each channel.
void draw_record(const WindowRecords& records, std::span<const double> row, const NoiseModel& noise,
                 const NoiseDraw& draw, bool noise_free, std::span<double> record);

}  // namespace strut
