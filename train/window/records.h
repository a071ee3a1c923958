// Noise-free records of a sweep's cases, and noisy ones drawn from them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "io/file/row_store.h"
#include "io/store/dataset.h"
#include "train/data/dataset_source.h"
#include "train/data/transform.h"

namespace strut {

/// Which window of the histories a network is to see.
struct WindowChoice {
  double from = 0.0, to = 0.0;  // s, on the time axis of the simulations
  /// s; records are shifted by up to so much, either way, to agree with the reference. 0: not at
  /// all. 50 ms: the hit time's 6 sigma, and what 2.5 % of speed change on 10 m of approach.
  double reach = 0.05;
  /// Most directions that are kept: inputs of the network.
  int components = 24;
};

struct WindowRecords {
  std::vector<ColumnInfo> channels, targets;
  WindowGrid grid;
  std::size_t spare = 0;  // samples beyond the record, on both sides, that drawn hit times take
  RowStore rows{1};       // channel by channel, then the targets
  std::int64_t skipped = 0;

  std::size_t samples() const { return grid.record_samples() + 2 * spare; }
};

/// Places the window on the samples of a dataset's histories. Throws InputError where it does not
/// fit in them with all that aligning takes and `spare` samples more on both sides.
WindowGrid make_window_grid(const ShardSchema& schema, const WindowChoice& choice,
                            std::size_t spare);

/// Samples that the hit times of `noise` may take.
std::size_t count_spare(const ShardSchema& schema, const NoiseModel& noise);

/// Reads the histories of the usable cases once; choice.inputs: history channels. Throws InputError
/// as read_usable_rows does, and where the dataset has none; CheckError where it was not
/// opened for them.
WindowRecords read_window_records(Dataset& dataset, const RowChoice& choice, const WindowGrid& grid,
                                  std::size_t spare, const RowStoreOptions& store);

/// The record of `row` (one of records.rows) with the hit time of a draw and, unless `noise_free`,
/// its biases and noise. `record`: room for grid.record_samples() of each channel.
void draw_record(const WindowRecords& records, std::span<const double> row, const NoiseModel& noise,
                 const NoiseDraw& draw, bool noise_free, std::span<double> record);

}  // namespace strut
