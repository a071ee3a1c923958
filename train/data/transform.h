// From a window of a measured time history to the few numbers that a network takes.
//
//   align     the record is shifted until it agrees best with a reference record, so that neither
//             the hit time nor a trigger has to be known
//   whiten    every channel by the inverse root of its noise covariance s^2 I + b^2 1 1': the noise
//             of white samples and of an unknown bias has unit variance in every direction then
//   project   on the directions in which noise-free records of the training differ most
//
// so that the noise of each number has variance 1 and is independent of the others' (exactly where
// nothing is aligned; interpolating between samples smooths white noise a little).
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "io/format/hdf5.h"
#include "train/data/noise.h"

namespace strut {

/// Where a window lies on the time axis of the records.
struct WindowGrid {
  double interval = 0.0;    // s, between samples
  std::int64_t first = 0;   // the window's first sample is that of time first * interval
  std::size_t samples = 0;  // of the window
  std::size_t lags = 0;     // samples by which a record may be shifted, either way; 0: not aligned

  /// Samples beyond the window, on both sides, that aligning takes.
  std::size_t margin() const;
  /// Samples of a record: margin, window, margin.
  std::size_t record_samples() const { return samples + 2 * margin(); }
};

struct WindowTransform {
  std::vector<ColumnInfo> channels;
  NoiseModel noise;  // of the channels
  WindowGrid grid;
  // Whitened windows, channel by channel.
  std::vector<double> reference;  // what records are aligned to; empty: nothing
  std::vector<double> mean;
  std::vector<double> basis;  // orthonormal directions, one after the other
  /// What the directions leave over of a record, per degree of freedom and over what reading
  /// between samples leaves of white noise (1: noise alone): mean and standard deviation over noisy
  /// training records.
  double leftover_mean = 1.0, leftover_deviation = 0.0;

  std::size_t window_size() const { return channels.size() * grid.samples; }
  std::size_t record_size() const { return channels.size() * grid.record_samples(); }
  std::size_t components() const { return basis.size() / window_size(); }
};

/// Where a window begins in a record.
struct WindowPlace {
  double begin = 0.0;  // in samples from the record's begin
  bool found = true;   // false: the agreement is best at an end of what was searched
};

/// How a record was read.
struct WindowReading {
  WindowPlace place;
  double leftover = 0.0;  // see WindowTransform
};

/// A record channel by channel, each of equally many samples.
struct RecordView {
  std::span<const double> values;
  std::size_t samples = 0;  // of each channel

  std::span<const double> channel(std::size_t c) const {
    return values.subspan(c * samples, samples);
  }
};

/// The place where the record's distance from the reference, in whitened numbers and apart from
/// biases, is least: whole samples first, then the vertex of the parabola through the three
/// distances around the least one. Searches the whole record, of whatever length; without aligning
/// it is the record's begin. Throws InputError where the record is shorter than the window and what
/// interpolation takes.
WindowPlace find_place(const WindowTransform& transform, const RecordView& record);

/// The window there, whitened: a channel's y becomes (y - q mean(y)) / s with
/// q = 1 - 1 / sqrt(1 + n (b / s)^2), which is (s^2 I + b^2 1 1')^(-1/2) y.
void read_white_window(const WindowTransform& transform, const RecordView& record, double begin,
                       std::span<double> window);

/// Projects a whitened window, whose content changes.
WindowReading project_window(const WindowTransform& transform, std::span<double> window,
                             std::span<double> components);

/// All of it: find the place, read the window, project it.
WindowReading read_components(const WindowTransform& transform, const RecordView& record,
                              std::span<double> components);

/// Names of the numbers: component_1, ...
std::vector<ColumnInfo> list_components(std::size_t count);

/// Where a model's file holds it.
inline constexpr char kWindowGroup[] = "/window";

void write_window(Hdf5Writer& file, const WindowTransform& transform);
/// Throws InputError that names file and dataset.
WindowTransform read_window(const std::filesystem::path& path, const Hdf5Reader& file);
void add_window(Checksum& sum, const WindowTransform& transform);

}  // namespace strut
