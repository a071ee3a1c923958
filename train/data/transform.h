// Reduces a window of a measured time history to the few components that a network takes.
//
//   align     shift the record until it agrees best with a reference record, so that neither the
//             hit time nor a trigger has to be known
//   whiten    multiply every channel by the inverse root of its noise covariance s^2 I + b^2 1 1':
//             white noise and an unknown bias then have unit variance in every direction
//   project   onto the directions in which noise-free records of the training differ most
//
// The noise of the components then has unit variance and is uncorrelated (exactly without aligning;
// interpolation between samples smooths white noise slightly).
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "io/format/hdf5.h"
#include "train/data/noise.h"

namespace strut {

/// Location of a window on the time axis of the records.
struct WindowGrid {
  double interval = 0.0;    // s, between samples
  std::int64_t first = 0;   // the window's first sample is at time first * interval
  std::size_t samples = 0;  // samples of the window
  std::size_t lags = 0;     // maximum shift of a record, either way, in samples; 0: not aligned

  /// Samples beyond the window, on each side, that aligning needs.
  std::size_t margin() const;
  /// Samples of a record: margin, window, margin.
  std::size_t record_samples() const { return samples + 2 * margin(); }
};

struct WindowTransform {
  std::vector<ColumnInfo> channels;
  NoiseModel noise;  // noise of the channels
  WindowGrid grid;
  // Whitened windows, channel by channel.
  std::vector<double> reference;  // records are aligned to it; empty: not aligned
  std::vector<double> mean;
  std::vector<double> basis;  // orthonormal directions, one after the other
  /// Residual of a record: its squared norm outside of the directions, per degree of freedom and
  /// relative to interpolated white noise (1: noise alone). Mean and standard deviation over noisy
  /// training records.
  double residual_mean = 1.0, residual_deviation = 0.0;

  std::size_t window_size() const { return channels.size() * grid.samples; }
  std::size_t record_size() const { return channels.size() * grid.record_samples(); }
  std::size_t components() const { return basis.size() / window_size(); }
  /// Degrees of freedom of a residual.
  double residual_degrees() const;
  /// Least number of samples of a record that the window is read from.
  std::size_t minimum_samples() const;
};

/// Start of the window in a record.
struct WindowAlignment {
  double begin = 0.0;  // in samples from the start of the record
  bool found = true;   // false: the best agreement is at an end of the searched range
};

/// Result of reading a record.
struct WindowReading {
  WindowAlignment alignment;
  double residual = 0.0;  // see WindowTransform
};

/// A record, channel by channel, all with the same number of samples.
struct RecordView {
  std::span<const double> values;
  std::size_t samples = 0;  // samples of each channel

  std::span<const double> channel(std::size_t c) const {
    return values.subspan(c * samples, samples);
  }
};

/// Finds the shift at which the whitened, bias-free distance between record and reference is
/// minimal: first over whole samples, then at the vertex of the parabola through the minimum and
/// its neighbors. Searches the whole record; without aligning the window begins with the record.
/// Throws InputError if the record is shorter than the window and the samples that interpolation
/// needs.
WindowAlignment find_alignment(const WindowTransform& transform, const RecordView& record);

/// Share q of its mean that whitening removes from each channel, and the largest residual of a
/// record like those of the training: five standard deviations above their mean.
std::vector<double> calc_mean_shares(const WindowTransform& transform);
double calc_residual_limit(const WindowTransform& transform);

/// Reads and whitens the window at `begin`: a channel's y becomes (y - q mean(y)) / s with
/// q = 1 - 1 / sqrt(1 + n (b / s)^2), which is (s^2 I + b^2 1 1')^(-1/2) y.
void read_white_window(const WindowTransform& transform, const RecordView& record, double begin,
                       std::span<double> window);

/// Projects a whitened window, whose content it overwrites; `alignment` is not set.
WindowReading project_window(const WindowTransform& transform, std::span<double> window,
                             std::span<double> components);

/// Aligns, reads and projects the window of a record.
WindowReading read_components(const WindowTransform& transform, const RecordView& record,
                              std::span<double> components);

/// Describes the components: component_1, ...
std::vector<ColumnInfo> list_components(std::size_t count);

/// Group of a window in a model's file.
inline constexpr char kWindowGroup[] = "/window";

void write_window(Hdf5Writer& file, const WindowTransform& transform);
/// Throws InputError, which names file and dataset.
WindowTransform read_window(const std::filesystem::path& path, const Hdf5Reader& file);
void add_window(Checksum& sum, const WindowTransform& transform);

}  // namespace strut
