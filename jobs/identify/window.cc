#include "jobs/identify/window.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>

#include "base/error/input_error.h"
#include "base/math/normal.h"
#include "base/text/format_number.h"
#include "base/text/range.h"
#include "io/store/shard_layout.h"
#include "train/data/shift.h"
#include "train/model/interval.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

/// Standard deviations by which what the directions leave over may exceed its mean.
constexpr double kLeftoverDeviations = 5.0;
/// Over the model's interval: the mean time between samples that still gives as many readings as
/// the intervals are for (at 1.25, of 400 Hz for 500 Hz, 89 % of the true values lay in those of 95
/// %); the longest time between two, which jitter may take; how far off the grid of the interval
/// samples may lie to be taken for it.
constexpr double kSlowest = 1.02, kWidestStep = 1.5, kOnGrid = 1e-3;

constexpr char kTime[] = "time";

void require_rate(const Measurement& measurement, double interval) {
  const std::vector<double>& times = measurement.values(kTime);
  const double mean = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
  if (mean > kSlowest * interval) {
    throw InputError(measurement.path.string() + ": " + format_rounded(1.0 / mean) +
                     " samples per second; must be at least " + format_rounded(1.0 / interval) +
                     ", as the model was trained with");
  }
  for (std::size_t i = 1; i < times.size(); ++i) {
    const double step = times[i] - times[i - 1];
    if (step > kWidestStep * interval) {
      throw InputError(measurement.locate(i) + ": " + format_rounded(step) +
                       " s after the sample before; must be at most " +
                       format_rounded(kWidestStep * interval) + " s, as the model takes " +
                       format_rounded(1.0 / interval) + " Hz");
    }
  }
}

void require_times(const Measurement& measurement, double interval) {
  const std::vector<double>& times = measurement.values(kTime);
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (!(times[i] > times[i - 1]))
      throw InputError(measurement.locate(i) + ": time must ascend; sort or cut the file there");
  }
  if (times.size() > 1) require_rate(measurement, interval);
}

bool is_on_grid(const std::vector<double>& times, double interval) {
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double at = times.front() + static_cast<double>(i) * interval;
    if (std::abs(times[i] - at) > kOnGrid * interval) return false;
  }
  return true;
}

/// The polynomial through six samples around `time`, the first of them `begin`.
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

/// Sample times of the record: from where it begins, or where the window does.
struct TimeGrid {
  double begin = 0.0;
  std::size_t samples = 0;
};

/// Instants that have three samples on either side, a first and a last one.
TimeGrid find_grid(const WindowTransform& window, const Measurement& measurement) {
  const std::vector<double>& times = measurement.values(kTime);
  const double interval = window.grid.interval;
  const bool aligned = window.grid.lags > 0;
  const std::size_t least =
      aligned ? window.grid.samples + 2 * ShiftStencil::kBefore + 2 : window.grid.samples;
  const bool on_grid = is_on_grid(times, interval);
  const std::size_t edge = on_grid ? 0 : ShiftStencil::kBefore;
  TimeGrid grid;
  if (times.size() > 2 * edge) {
    const double first = times[edge], last = times[times.size() - 1 - edge];
    grid.begin = aligned ? first : static_cast<double>(window.grid.first) * interval;
    const double span = (last - grid.begin) / interval + kOnGrid;
    if (grid.begin > first - kOnGrid * interval && span > 0.0) {
      grid.samples = static_cast<std::size_t>(span) + 1;
    }
  }
  if (grid.samples < least) {
    const auto needed = static_cast<double>(least + 2 * edge - 1) * interval;
    throw InputError(measurement.path.string() + ": the record is from " +
                     format_rounded(times.front()) + " to " + format_rounded(times.back()) +
                     " s; the window takes " + format_rounded(needed) + " s" +
                     (aligned ? "" : " from " + format_rounded(grid.begin) + " s on") +
                     "; record longer, or `strut train` with a shorter --window");
  }
  return grid;
}

std::vector<double> resample(const Measurement& measurement, const std::string& channel,
                             const TimeGrid& grid, double interval) {
  constexpr std::size_t kNodes = ShiftStencil::kSamples, kBefore = ShiftStencil::kBefore;
  const std::span<const double> times = measurement.values(kTime);
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

std::vector<OutsideChannel> list_outside(const TrainedModel& model, const MeasuredRecord& record,
                                         const WindowReading& reading,
                                         const std::vector<double>& components) {
  const WindowTransform& window = *model.window;
  std::vector<OutsideChannel> outside;
  const auto judge = [&](const std::string& name, const std::string& unit, double value, double low,
                         double high, double margin) {
    if (value >= low - margin && value <= high + margin) return;
    outside.push_back({name, unit, value, low, high, calc_excess(value, low, high)});
  };
  if (!reading.alignment.found) {
    const double begin = record.begin + reading.alignment.begin * window.grid.interval;
    outside.push_back({"alignment", "s", begin, std::nan(""), std::nan(""), 0.0});
    return outside;  // the numbers of a window elsewhere tell nothing more
  }
  const double limit = window.residual_mean + kLeftoverDeviations * window.residual_deviation;
  judge("leftover", "1", reading.residual, 0.0, limit, 0.0);
  for (std::size_t k = 0; k < components.size(); ++k) {
    judge(model.inputs[k].name, model.inputs[k].unit, components[k], model.input_map.low()[k],
          model.input_map.high()[k], kNormal95);
  }
  return outside;
}

}  // namespace

MeasuredRecord read_record(const WindowTransform& window, const fs::path& file) {
  MeasurementRequest request{{kTime}, {}, MeasuredPart::kHistory};
  for (const ColumnInfo& channel : window.channels) request.required.push_back(channel.name);
  const Measurement measurement = read_measurement(file, request);
  require_units(measurement, window.channels);
  require_units(measurement, {{kTime, "s", ""}});
  require_times(measurement, window.grid.interval);
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

IdentifiedRow identify_record(const TrainedModel& model, const Identifier& identifier,
                              const MeasuredRecord& record, bool extrapolate) {
  std::vector<double> components(model.inputs.size());
  const WindowReading reading =
      read_components(*model.window, {record.values, record.samples}, components);
  IdentifiedRow row;
  row.outside = list_outside(model, record, reading, components);
  const bool inside = row.outside.empty();
  const std::size_t m = model.targets.size();
  std::vector<double> values(m, std::nan(""));
  if (inside || extrapolate) identifier.identify(components.data(), values.data());
  row.parameters.reserve(m);
  for (std::size_t t = 0; t < m; ++t) {
    IdentifiedParameter p{model.targets[t].name, model.targets[t].unit, values[t]};
    if (inside) p.half_width = model.ci95[t];
    p.in_range = inside && is_parameter_in_range(model, t, p.value, model.ci95[t]);
    row.parameters.push_back(std::move(p));
  }
  return row;
}

int identify_by_window(const Arguments& arguments, const TrainedModel& model,
                       const std::vector<fs::path>& files) {
  if (files.empty())
    throw arguments.usage_error("MEASURED: missing; name a history with the model's channels");
  for (const char* option : {"set", "event-time", "noise"}) {
    if (!arguments.has(option)) continue;
    throw InputError("--" + std::string(option) +
                     " is for snapshots; the model takes a window of a time history");
  }
  const Identifier identifier(model);
  std::vector<IdentifiedRow> rows;
  rows.reserve(files.size());
  for (const fs::path& file : files) {
    rows.push_back(identify_record(model, identifier, read_record(*model.window, file),
                                   arguments.is_on("extrapolate")));
    rows.back().place = file.string();
  }
  return show_identified(arguments, rows);
}

}  // namespace strut
