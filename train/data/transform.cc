#include "train/data/transform.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error/input_error.h"
#include "train/data/shift.h"

namespace strut {
namespace {

using ConstMap = Eigen::Map<const Eigen::ArrayXd>;
using MutableMap = Eigen::Map<Eigen::ArrayXd>;

ConstMap map_values(const double* first, std::size_t count) {
  return {first, static_cast<Eigen::Index>(count)};
}

/// Squared distance of a record's window at `begin`, whitened and without its mean, from the
/// reference. Summed as it stands: the difference of larger sums would lose the digits that place
/// the window.
double calc_distance(const WindowTransform& transform, const RecordView& record,
                     std::size_t begin) {
  const std::size_t n = transform.grid.samples;
  double distance = 0.0;
  for (std::size_t c = 0; c < transform.channels.size(); ++c) {
    const ConstMap y = map_values(record.channel(c).data() + begin, n);
    const ConstMap reference = map_values(transform.reference.data() + c * n, n);
    const double mean = y.mean(), factor = 1.0 / transform.noise.sigma[c];
    distance += ((y - mean) * factor - reference).square().sum();
  }
  return distance;
}

double calc_mean_share(double sigma, double bias, std::size_t n) {
  return 1.0 - 1.0 / std::sqrt(1.0 + static_cast<double>(n) * (bias / sigma) * (bias / sigma));
}

void whiten(double sigma, double bias, std::span<double> window) {
  MutableMap y(window.data(), static_cast<Eigen::Index>(window.size()));
  const double q = calc_mean_share(sigma, bias, window.size());
  const double mean = y.mean();
  y = (y - q * mean) / sigma;
}

}  // namespace

std::size_t WindowGrid::margin() const { return lags > 0 ? lags + ShiftStencil::kBefore : 0; }

std::vector<double> calc_mean_shares(const WindowTransform& transform) {
  const NoiseModel& noise = transform.noise;
  std::vector<double> shares;
  shares.reserve(noise.sigma.size());
  for (std::size_t c = 0; c < noise.sigma.size(); ++c) {
    shares.push_back(calc_mean_share(noise.sigma[c], noise.bias[c], transform.grid.samples));
  }
  return shares;
}

double calc_residual_limit(const WindowTransform& transform) {
  constexpr double kMaxDeviations = 5.0;
  return transform.residual_mean + kMaxDeviations * transform.residual_deviation;
}

double WindowTransform::residual_degrees() const {
  return std::max(static_cast<double>(window_size() - components()), 1.0);
}

std::size_t WindowTransform::minimum_samples() const {
  return grid.samples + (grid.lags > 0 ? 2 * ShiftStencil::kBefore + 2 : 0);
}

WindowAlignment find_alignment(const WindowTransform& transform, const RecordView& record) {
  const WindowGrid& grid = transform.grid;
  const std::size_t needed = transform.minimum_samples();
  if (record.samples < needed) {
    throw InputError(fmt::format("a record of {} samples; the window needs at least {}",
                                 record.samples, needed));
  }
  if (transform.reference.empty()) return {0.0, true};
  const std::size_t first = ShiftStencil::kBefore;
  const std::size_t last = record.samples - grid.samples - ShiftStencil::kBefore;
  std::vector<double> distances;
  distances.reserve(last - first + 1);
  for (std::size_t begin = first; begin <= last; ++begin) {
    // Huge samples overflow: their windows are the farthest.
    const double distance = calc_distance(transform, record, begin);
    constexpr double kMax = std::numeric_limits<double>::max();
    distances.push_back(distance <= kMax ? distance : kMax);
  }
  const auto min = std::min_element(distances.begin(), distances.end());
  const auto begin = static_cast<double>(first) + static_cast<double>(min - distances.begin());
  if (min == distances.begin() || min + 1 == distances.end()) return {begin, false};
  const double before = *(min - 1), here = *min, after = *(min + 1);
  const double curvature = before - 2.0 * here + after;
  return {begin + (curvature > 0.0 ? 0.5 * (before - after) / curvature : 0.0), true};
}

void read_white_window(const WindowTransform& transform, const RecordView& record, double begin,
                       std::span<double> window) {
  const std::size_t n = transform.grid.samples;
  for (std::size_t c = 0; c < transform.channels.size(); ++c) {
    const std::span<double> to = window.subspan(c * n, n);
    if (transform.grid.lags > 0) {
      read_shifted(record.channel(c), begin, to);
    } else {
      std::copy_n(record.channel(c).begin(), n, to.begin());
    }
    whiten(transform.noise.sigma[c], transform.noise.bias[c], to);
  }
}

WindowReading project_window(const WindowTransform& transform, std::span<double> window,
                             std::span<double> components) {
  const std::size_t size = transform.window_size();
  MutableMap x(window.data(), static_cast<Eigen::Index>(size));
  x -= map_values(transform.mean.data(), size);
  double residual = x.square().sum();
  for (std::size_t k = 0; k < transform.components(); ++k) {
    components[k] = (map_values(transform.basis.data() + k * size, size) * x).sum();
    residual -= components[k] * components[k];
  }
  return {{}, std::max(residual, 0.0) / transform.residual_degrees()};
}

WindowReading read_components(const WindowTransform& transform, const RecordView& record,
                              std::span<double> components) {
  const WindowAlignment alignment = find_alignment(transform, record);
  std::vector<double> window(transform.window_size());
  read_white_window(transform, record, alignment.begin, window);
  WindowReading reading = project_window(transform, window, components);
  reading.alignment = alignment;
  if (transform.grid.lags > 0) {
    reading.residual /= calc_shift_gain(alignment.begin - std::floor(alignment.begin));
  }
  return reading;
}

std::vector<ColumnInfo> list_components(std::size_t count) {
  std::vector<ColumnInfo> columns;
  columns.reserve(count);
  for (std::size_t k = 1; k <= count; ++k) {
    columns.push_back({fmt::format("component_{}", k), "1",
                       "coordinate of the window along a direction; unit of the noise"});
  }
  return columns;
}

}  // namespace strut
