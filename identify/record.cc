#include "identify/record.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "base/error/input_error.h"
#include "base/text/format_number.h"
#include "identify/history.h"
#include "train/data/shift.h"

namespace strut {
namespace {

/// Limits as multiples of the model's interval. Maximum mean interval of the samples: with fewer
/// readings the confidence intervals are too narrow (at 1.25, 400 Hz instead of 500 Hz, those of 95
/// % covered 89 % of the true values). Maximum single interval, including jitter. Maximum distance
/// from the model's grid of samples that are not interpolated.
constexpr double kMaxMeanInterval = 1.02, kMaxInterval = 1.5, kGridTolerance = 1e-3;

/// Throws InputError where samples are fewer, or farther apart, than a model of this interval [s]
/// needs.
void require_rate(const Measurement& measurement, double interval) {
  const std::vector<double>& times = measurement.values(kTimeColumn);
  if (times.size() < 2) return;
  const double mean = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
  if (mean > kMaxMeanInterval * interval) {
    throw InputError(fmt::format(
        "{}: {} samples per second; must be at least {}, the rate that the model was trained "
        "with",
        measurement.path.string(), format_rounded(1.0 / mean), format_rounded(1.0 / interval)));
  }
  for (std::size_t i = 1; i < times.size(); ++i) {
    const double step = times[i] - times[i - 1];
    if (step > kMaxInterval * interval) {
      throw InputError(fmt::format(
          "{}: {} s after the sample before; must be at most {} s, as the model takes {} Hz",
          measurement.locate(i), format_rounded(step), format_rounded(kMaxInterval * interval),
          format_rounded(1.0 / interval)));
    }
  }
}

bool is_on_grid(const std::vector<double>& times, double interval) {
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double at = times.front() + static_cast<double>(i) * interval;
    if (std::abs(times[i] - at) > kGridTolerance * interval) return false;
  }
  return true;
}

/// Lagrange's polynomial through the samples, at `time`.
double interpolate(std::span<const double> times, std::span<const double> values, double time) {
  double sum = 0.0;
  for (std::size_t a = 0; a < times.size(); ++a) {
    double weight = 1.0;
    for (std::size_t b = 0; b < times.size(); ++b) {
      if (a != b) weight *= (time - times[b]) / (times[a] - times[b]);
    }
    sum += weight * values[a];
  }
  return sum;
}

/// Sample times of a record: `samples` instants from `begin` [s] on.
struct TimeGrid {
  double begin = 0.0;
  std::size_t samples = 0;
};

/// Finds the sample times of a record, from its start or, for a window that is not aligned, from
/// the window's start. Off the grid, each instant has three samples on either side.
TimeGrid find_grid(const WindowTransform& window, const Measurement& measurement) {
  const std::vector<double>& times = measurement.values(kTimeColumn);
  const double interval = window.grid.interval;
  const bool aligned = window.grid.lags > 0;
  const std::size_t needed_samples = window.minimum_samples();
  const bool on_grid = is_on_grid(times, interval);
  const std::size_t edge = on_grid ? 0 : ShiftStencil::kBefore;
  TimeGrid grid;
  if (times.size() > 2 * edge) {
    const double first = times[edge], last = times[times.size() - 1 - edge];
    grid.begin = aligned ? first : static_cast<double>(window.grid.first) * interval;
    const double span = (last - grid.begin) / interval + kGridTolerance;
    if (grid.begin > first - kGridTolerance * interval && span > 0.0) {
      grid.samples = static_cast<std::size_t>(span) + 1;
    }
  }
  if (grid.samples < needed_samples) {
    const auto needed = static_cast<double>(needed_samples + 2 * edge - 1) * interval;
    throw InputError(
        fmt::format("{}: the record is from {} to {} s; the window takes {} s{}; record longer, or "
                    "`strut train` with a shorter --window",
                    measurement.path.string(), format_rounded(times.front()),
                    format_rounded(times.back()), format_rounded(needed),
                    aligned ? "" : fmt::format(" from {} s on", format_rounded(grid.begin))));
  }
  return grid;
}

std::vector<double> resample(const Measurement& measurement, const std::string& channel,
                             const TimeGrid& grid, double interval) {
  constexpr std::size_t kNodes = ShiftStencil::kSamples, kBefore = ShiftStencil::kBefore;
  const std::span<const double> times = measurement.values(kTimeColumn);
  const std::span<const double> values = measurement.values(channel);
  std::vector<double> samples;
  samples.reserve(grid.samples);
  for (std::size_t i = 0; i < grid.samples; ++i) {
    const double time = grid.begin + static_cast<double>(i) * interval;
    const auto after = static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), time) -
                                                times.begin());
    const std::size_t begin =
        std::min(after - std::min(after, kBefore), times.size() - std::min(times.size(), kNodes));
    const std::size_t count = std::min(kNodes, times.size());
    samples.push_back(interpolate(times.subspan(begin, count), values.subspan(begin, count), time));
  }
  return samples;
}

}  // namespace

MeasuredRecord read_record(const WindowTransform& window, const std::filesystem::path& file,
                           const ColumnMap& map) {
  const Measurement measurement = read_history(file, window.channels, map);
  require_ascending_times(measurement);
  require_rate(measurement, window.grid.interval);
  const TimeGrid grid = find_grid(window, measurement);
  MeasuredRecord record;
  record.samples = grid.samples;
  record.begin = grid.begin;
  for (const ColumnInfo& channel : window.channels) {
    const auto samples = resample(measurement, channel.name, grid, window.grid.interval);
    record.values.insert(record.values.end(), samples.begin(), samples.end());
  }
  return record;
}

}  // namespace strut
