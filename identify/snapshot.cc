#include "identify/snapshot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error/input_error.h"
#include "base/math/normal.h"
#include "base/text/format_number.h"
#include "identify/history.h"
#include "io/store/measurement.h"
#include "io/store/shard_layout.h"
#include "train/model/interval.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

std::vector<OutsideChannel> list_outside(const TrainedModel& model, const SnapshotOptions& options,
                                         const double* inputs) {
  std::vector<OutsideChannel> outside;
  for (std::size_t i = 0; i < model.inputs.size(); ++i) {
    const double low = model.input_map.low()[i], high = model.input_map.high()[i];
    const double margin = kNormal95 * options.noise[i];
    if (inputs[i] >= low - margin && inputs[i] <= high + margin) continue;
    outside.push_back({model.inputs[i].name, model.inputs[i].unit, inputs[i], low, high,
                       calc_excess(inputs[i], low, high)});
  }
  return outside;
}

/// Standard deviation of each parameter due to the noise of the inputs.
std::vector<double> calc_noise(const Identifier& identifier, const SnapshotOptions& options,
                               const double* inputs, std::size_t targets) {
  std::vector<double> sigma(targets, 0.0);
  const auto is_zero = [](double s) { return s == 0.0; };
  if (std::all_of(options.noise.begin(), options.noise.end(), is_zero)) return sigma;
  const std::vector<double> jacobian = identifier.calc_jacobian(inputs);
  const std::size_t n = options.noise.size();
  for (std::size_t t = 0; t < targets; ++t) {
    double sum = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      const double part = jacobian[t * n + i] * options.noise[i];
      sum += part * part;
    }
    sigma[t] = std::sqrt(sum);
  }
  return sigma;
}

void append_rows(const TrainedModel& model, const Measurement& measurement, Snapshots& snapshots) {
  std::vector<const std::vector<double>*> columns;
  columns.reserve(model.inputs.size());
  for (const ColumnInfo& input : model.inputs) columns.push_back(&measurement.values(input.name));
  for (std::size_t row = 0; row < measurement.row_count(); ++row) {
    for (const std::vector<double>* column : columns) snapshots.rows.push_back((*column)[row]);
    snapshots.sources.push_back(measurement.locate(row));
  }
}

/// Interpolates linearly between the two samples around `time`.
void append_instant(const TrainedModel& model, const Measurement& history, double time,
                    Snapshots& snapshots) {
  require_ascending_times(history);
  const std::vector<double>& times = history.values(kTimeColumn);
  if (!(time >= times.front() && time <= times.back())) {
    throw InputError(fmt::format("{}: --event-time = {}: must be in [{}, {}] s, the times measured",
                                 history.path.string(), format_number(time),
                                 format_number(times.front()), format_number(times.back())));
  }
  const auto after =
      static_cast<std::size_t>(std::lower_bound(times.begin(), times.end(), time) - times.begin());
  const std::size_t before = after == 0 ? 0 : after - 1;
  const double fraction =
      after == before ? 0.0 : (time - times[before]) / (times[after] - times[before]);
  for (const ColumnInfo& input : model.inputs) {
    const std::vector<double>& values = history.values(input.name);
    snapshots.rows.push_back((1.0 - fraction) * values[before] + fraction * values[after]);
  }
  snapshots.sources.push_back(
      fmt::format("{} at {} s", history.path.string(), format_number(time)));
}

void append_table(const TrainedModel& model, const fs::path& file, const ColumnMap& map,
                  Snapshots& snapshots) {
  const Measurement table =
      read_channels(file, MeasuredPart::kSnapshot, model.inputs, {{kTimeColumn, "s", ""}}, map);
  if (table.find(kTimeColumn) != nullptr && table.row_count() > 1) {
    throw InputError(fmt::format(
        "{}: a time history (column '{}', {} rows); the model takes the readings at one "
        "instant: name it with --event-time T",
        file.string(), kTimeColumn, table.row_count()));
  }
  append_rows(model, table, snapshots);
}

}  // namespace

Snapshots read_snapshots(const TrainedModel& model, const std::vector<fs::path>& files,
                         std::optional<double> event_time, const ColumnMap& map) {
  Snapshots snapshots;
  for (const fs::path& file : files) {
    if (event_time) {
      append_instant(model, read_history(file, model.inputs, map), *event_time, snapshots);
    } else {
      append_table(model, file, map, snapshots);
    }
  }
  return snapshots;
}

IdentifiedRow identify_snapshot(const TrainedModel& model, const Identifier& identifier,
                                const SnapshotOptions& options, const double* inputs) {
  const std::size_t m = model.targets.size();
  IdentifiedRow row;
  row.outside = list_outside(model, options, inputs);
  const bool inside = row.outside.empty();
  std::vector<double> values(m, std::nan(""));
  if (inside || options.extrapolate) identifier.identify(inputs, values.data());
  const std::vector<double> sigma = calc_noise(identifier, options, inputs, m);
  row.parameters.reserve(m);
  for (std::size_t t = 0; t < m; ++t) {
    IdentifiedParameter p{model.targets[t].name, model.targets[t].unit, values[t]};
    const double half = std::hypot(model.ci95[t], kNormal95 * sigma[t]);
    if (inside) p.half_width = half;
    p.in_range = inside && is_parameter_in_range(model, t, p.value, half);
    row.parameters.push_back(std::move(p));
  }
  return row;
}

std::vector<IdentifiedRow> identify_snapshots(const TrainedModel& model,
                                              const SnapshotOptions& options,
                                              const Snapshots& snapshots) {
  const Identifier identifier(model);
  const std::size_t n = model.inputs.size();
  std::vector<IdentifiedRow> rows;
  rows.reserve(snapshots.sources.size());
  for (std::size_t i = 0; i < snapshots.sources.size(); ++i) {
    rows.push_back(identify_snapshot(model, identifier, options, snapshots.rows.data() + i * n));
    rows.back().source = snapshots.sources[i];
  }
  return rows;
}

}  // namespace strut
