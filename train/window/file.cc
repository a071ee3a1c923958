// Writes and reads a window's transform in a model's file.
#include <fmt/format.h>

#include "base/math/all_finite.h"
#include "io/store/shard_layout.h"
#include "train/data/training_file.h"
#include "train/data/transform.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

constexpr char kNoise[] = "/window/noise", kMean[] = "/window/mean", kBasis[] = "/window/basis",
               kReference[] = "/window/reference";

std::size_t read_count(const fs::path& path, const Hdf5Reader& file, const char* key) {
  const std::int64_t value = file.read_integer_attribute(kWindowGroup, key);
  if (value < 0) fail_file(path, fmt::format("{}: {}: must be at least 0", kWindowGroup, key));
  return static_cast<std::size_t>(value);
}

std::vector<double> read_finite(const fs::path& path, const Hdf5Reader& file, const char* name) {
  std::vector<double> values = file.read(name).values;
  if (!all_finite(values)) fail_file(path, fmt::format("{}: must be finite", name));
  return values;
}

void check_shapes(const fs::path& path, const WindowTransform& transform) {
  const std::size_t size = transform.window_size();
  const bool aligned = transform.grid.lags > 0;
  if (size == 0 || !(transform.grid.interval > 0.0) || transform.mean.size() != size ||
      transform.basis.empty() || transform.basis.size() % size != 0 ||
      transform.components() >= size || transform.reference.size() != (aligned ? size : 0)) {
    fail_file(path, fmt::format("{}: mean, basis and reference do not fit the channels and samples "
                                "of the window",
                                kWindowGroup));
  }
}

}  // namespace

void write_window(Hdf5Writer& file, const WindowTransform& transform) {
  const WindowGrid& grid = transform.grid;
  write_noise(file, kNoise, transform.noise, transform.channels);
  file.write(kMean, transform.mean, grid.samples,
             {"1", "mean whitened window of the training part, a row a channel", {}});
  file.write(kBasis, transform.basis, transform.window_size(),
             {"1", "directions in whitened windows, a row each, channel behind channel", {}});
  if (!transform.reference.empty()) {
    file.write(kReference, transform.reference, grid.samples,
               {"1", "window that records are aligned to, over sigma and without mean", {}});
  }
  file.write_attribute(kWindowGroup, "interval", grid.interval);
  file.write_attribute(kWindowGroup, "first_sample", grid.first);
  file.write_attribute(kWindowGroup, "samples", static_cast<std::int64_t>(grid.samples));
  file.write_attribute(kWindowGroup, "lags", static_cast<std::int64_t>(grid.lags));
  file.write_attribute(kWindowGroup, "leftover_mean", transform.residual_mean);
  file.write_attribute(kWindowGroup, "leftover_deviation", transform.residual_deviation);
}

WindowTransform read_window(const fs::path& path, const Hdf5Reader& file) {
  WindowTransform transform;
  transform.noise = read_noise(path, file, kNoise, transform.channels);
  transform.grid = {file.read_number_attribute(kWindowGroup, "interval"),
                    file.read_integer_attribute(kWindowGroup, "first_sample"),
                    read_count(path, file, "samples"), read_count(path, file, "lags")};
  transform.mean = read_finite(path, file, kMean);
  transform.basis = read_finite(path, file, kBasis);
  if (transform.grid.lags > 0) transform.reference = read_finite(path, file, kReference);
  transform.residual_mean = file.read_number_attribute(kWindowGroup, "leftover_mean");
  transform.residual_deviation = file.read_number_attribute(kWindowGroup, "leftover_deviation");
  check_shapes(path, transform);
  return transform;
}

void add_window(Checksum& sum, const WindowTransform& transform) {
  const WindowGrid& grid = transform.grid;
  sum.add(transform.channels);
  add_noise(sum, transform.noise);
  sum.add(
      std::vector<double>{grid.interval, transform.residual_mean, transform.residual_deviation});
  sum.add(std::vector<std::int64_t>{grid.first, static_cast<std::int64_t>(grid.samples),
                                    static_cast<std::int64_t>(grid.lags)});
  sum.add(transform.reference);
  sum.add(transform.mean);
  sum.add(transform.basis);
}

}  // namespace strut
