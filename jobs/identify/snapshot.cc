#include "jobs/identify/snapshot.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <span>

#include "base/math/normal.h"
#include "base/text/format_number.h"
#include "base/text/nearest_name.h"
#include "base/text/range.h"
#include "io/store/measurement.h"
#include "io/store/shard_layout.h"
#include "model_files/parameters.h"
#include "train/model/interval.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

constexpr char kTime[] = "time";

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

/// Standard deviation of each parameter that the noise of the inputs makes.
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

/// Position of an input in the model. Throws InputError.
std::size_t find_input(const TrainedModel& model, const std::string& option,
                       const std::string& name) {
  const std::vector<std::string> names = list_names(model.inputs);
  const auto at = std::find(names.begin(), names.end(), name);
  if (at != names.end()) return static_cast<std::size_t>(at - names.begin());
  throw InputError("--" + option + ": no input '" + name + "' of the model; it has " +
                   join_names(names) + suggest_name(name, names));
}

/// Values of an option NAME=VALUE for the model's inputs; NaN where one is not named.
std::vector<double> read_settings(const Arguments& arguments, const TrainedModel& model,
                                  const std::string& option) {
  std::vector<double> values(model.inputs.size(), std::nan(""));
  for (const std::string& setting : arguments.list(option)) {
    const auto [name, value] = parse_setting(setting);
    double& place = values[find_input(model, option, name)];
    if (!std::isfinite(value))
      throw InputError("--" + option + ": " + setting + ": not finite; must be a number");
    place = value;
  }
  return values;
}

SnapshotOptions read_options(const Arguments& arguments, const TrainedModel& model) {
  SnapshotOptions options;
  options.extrapolate = arguments.is_on("extrapolate");
  options.noise = read_settings(arguments, model, "noise");
  for (double& sigma : options.noise) {
    if (std::isnan(sigma)) sigma = 0.0;
    if (sigma < 0.0) throw InputError("--noise: a sigma below 0; allowed: 0 and above");
  }
  return options;
}

/// Snapshots by rows, and where each was measured.
struct Snapshots {
  std::vector<double> rows;
  std::vector<std::string> places;
};

Snapshots read_command_line(const Arguments& arguments, const TrainedModel& model) {
  Snapshots snapshots{read_settings(arguments, model, "set"), {"--set"}};
  std::vector<std::string> missing;
  for (std::size_t i = 0; i < model.inputs.size(); ++i) {
    if (std::isnan(snapshots.rows[i])) missing.push_back(model.inputs[i].name);
  }
  if (missing.empty()) return snapshots;
  throw InputError("--set: missing " + join_names(missing) + "; the model needs " +
                   join_names(list_names(model.inputs)));
}

void append_rows(const TrainedModel& model, const Measurement& measurement, Snapshots& snapshots) {
  std::vector<const std::vector<double>*> columns;
  columns.reserve(model.inputs.size());
  for (const ColumnInfo& input : model.inputs) columns.push_back(&measurement.values(input.name));
  for (std::size_t row = 0; row < measurement.row_count(); ++row) {
    for (const std::vector<double>* column : columns) snapshots.rows.push_back((*column)[row]);
    snapshots.places.push_back(measurement.locate(row));
  }
}

/// Between the two samples around `time`, on the straight line.
void append_instant(const TrainedModel& model, const Measurement& history, double time,
                    Snapshots& snapshots) {
  const std::vector<double>& times = history.values(kTime);
  const auto unordered = std::adjacent_find(times.begin(), times.end(), std::greater_equal<>());
  if (unordered != times.end()) {
    throw InputError(history.locate(static_cast<std::size_t>(unordered - times.begin()) + 1) +
                     ": time must ascend; sort or cut the file there");
  }
  if (!(time >= times.front() && time <= times.back())) {
    throw InputError(history.path.string() + ": --event-time = " + format_number(time) +
                     ": must be in [" + format_number(times.front()) + ", " +
                     format_number(times.back()) + "] s, the times measured");
  }
  const auto after =
      static_cast<std::size_t>(std::lower_bound(times.begin(), times.end(), time) - times.begin());
  const std::size_t before = after == 0 ? 0 : after - 1;
  const double share =
      after == before ? 0.0 : (time - times[before]) / (times[after] - times[before]);
  for (const ColumnInfo& input : model.inputs) {
    const std::vector<double>& values = history.values(input.name);
    snapshots.rows.push_back((1.0 - share) * values[before] + share * values[after]);
  }
  snapshots.places.push_back(history.path.string() + " at " + format_number(time) + " s");
}

void append_file(const Arguments& arguments, const TrainedModel& model, const fs::path& file,
                 Snapshots& snapshots) {
  const double time = arguments.number_or("event-time", std::nan(""), Range{});
  const bool at_instant = !std::isnan(time);
  MeasurementRequest request{list_names(model.inputs), {kTime}};
  if (at_instant) {
    request.required.emplace_back(kTime);
    request.optional.clear();
    request.part = MeasuredPart::kHistory;
  }
  const Measurement measurement = read_measurement(file, request);
  require_units(measurement, model.inputs);
  if (at_instant) return append_instant(model, measurement, time, snapshots);
  if (measurement.find(kTime) != nullptr && measurement.row_count() > 1) {
    throw InputError(file.string() + ": a time history (column 'time', " +
                     std::to_string(measurement.row_count()) +
                     " rows); the model takes what was measured at one instant: name it with "
                     "--event-time T");
  }
  append_rows(model, measurement, snapshots);
}

Snapshots read_snapshots(const Arguments& arguments, const TrainedModel& model,
                         const std::vector<fs::path>& files) {
  if (arguments.has("set") && !files.empty()) {
    throw arguments.usage_error("--set gives the snapshot: name no file beside it");
  }
  if (arguments.has("set")) return read_command_line(arguments, model);
  if (files.empty())
    throw arguments.usage_error(
        "MEASURED: missing; name a table with a column for each input, or give --set");
  Snapshots snapshots;
  for (const fs::path& file : files) append_file(arguments, model, file, snapshots);
  return snapshots;
}

}  // namespace

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

void add_snapshot_options(Arguments& arguments) {
  arguments.add_list("set", "NAME=VALUE",
                     "snapshot: an input of the model, instead of a file;\n"
                     "fit: a parameter, known or, if free, where the search starts; repeatable");
  arguments.add_list("noise", "CHANNEL=SIGMA",
                     "1 sigma of a sensor's white noise, repeatable; snapshot: widens the\n"
                     "intervals (default 0); fit: weighs the readings (default: of MEMS sensors)");
  arguments.add_option("event-time", "T",
                       "snapshot: the instant [s] of it in a time history: between its two\n"
                       "samples, on the straight line");
  arguments.add_switch("extrapolate",
                       "snapshot, window: give values outside of the range trained on, too");
}

int identify_by_snapshot(const Arguments& arguments, const TrainedModel& model,
                         const std::vector<fs::path>& files) {
  const SnapshotOptions options = read_options(arguments, model);
  Snapshots snapshots = read_snapshots(arguments, model, files);
  const Identifier identifier(model);
  const std::size_t n = model.inputs.size();
  std::vector<IdentifiedRow> rows;
  rows.reserve(snapshots.places.size());
  for (std::size_t i = 0; i < snapshots.places.size(); ++i) {
    rows.push_back(identify_snapshot(model, identifier, options, snapshots.rows.data() + i * n));
    rows.back().place = std::move(snapshots.places[i]);
  }
  return show_identified(arguments, rows);
}

}  // namespace strut
