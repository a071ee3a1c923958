#include "jobs/identify/snapshot.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "base/text/nearest_name.h"
#include "base/text/range.h"
#include "identify/snapshot.h"
#include "io/store/shard_layout.h"
#include "jobs/cli/settings.h"
#include "jobs/identify/columns.h"
#include "jobs/identify/result.h"
#include "jobs/identify/wear.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

SnapshotOptions read_options(const Arguments& arguments, const TrainedModel& model) {
  SnapshotOptions options;
  options.extrapolate = arguments.is_on("extrapolate");
  options.noise.assign(model.inputs.size(), 0.0);
  apply_settings("noise", arguments.list("noise"), list_names(model.inputs), options.noise);
  for (const double sigma : options.noise) {
    if (sigma < 0.0) throw InputError("--noise: a sigma below 0; allowed: 0 and above");
  }
  return options;
}

/// The snapshot of --set.
Snapshots read_command_line(const Arguments& arguments, const TrainedModel& model) {
  const std::vector<std::string> names = list_names(model.inputs);
  Snapshots snapshots{std::vector<double>(names.size(), std::nan("")), {"--set"}};
  apply_settings("set", arguments.list("set"), names, snapshots.rows);
  std::vector<std::string> missing;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (std::isnan(snapshots.rows[i])) missing.push_back(names[i]);
  }
  if (missing.empty()) return snapshots;
  throw InputError(
      fmt::format("--set: missing {}; the model needs {}", join_names(missing), join_names(names)));
}

std::optional<double> read_event_time(const Arguments& arguments) {
  if (!arguments.has("event-time")) return std::nullopt;
  return arguments.number_or("event-time", 0.0, Range{});
}

Snapshots read_measured(const Arguments& arguments, const TrainedModel& model,
                        const std::vector<fs::path>& files) {
  if (arguments.has("set") && !files.empty()) {
    throw arguments.usage_error("--set gives the snapshot: name no file beside it");
  }
  if (arguments.has("set")) return read_command_line(arguments, model);
  if (files.empty()) {
    throw arguments.usage_error(
        "MEASURED: missing; name a table with a column for each input, or give --set");
  }
  return read_snapshots(model, files, read_event_time(arguments),
                        read_columns_option(arguments, model.inputs));
}

}  // namespace

void add_snapshot_options(Arguments& arguments) {
  arguments.add_list("set", "NAME=VALUE",
                     "snapshot: an input of the model, instead of a file;\n"
                     "fit: a parameter, or the start value of a free one; repeatable");
  arguments.add_list("noise", "CHANNEL=SIGMA",
                     "1 sigma of a sensor's white noise, repeatable; snapshot: widens the\n"
                     "intervals (default 0); fit: weights the readings (default: MEMS sensors)");
  arguments.add_option("event-time", "T",
                       "snapshot: its time [s] in a time history, interpolated linearly\n"
                       "between the two samples around it");
  arguments.add_switch("extrapolate",
                       "snapshot, window: also give values outside of the range trained on");
}

int identify_by_snapshot(const Arguments& arguments, const TrainedModel& model,
                         const std::vector<fs::path>& files) {
  const SnapshotOptions options = read_options(arguments, model);
  const Snapshots snapshots = read_measured(arguments, model, files);
  const Snapshots before = read_snapshots(model, list_before(arguments), read_event_time(arguments),
                                          read_columns_option(arguments, model.inputs));
  return show_identified(arguments, identify_snapshots(model, options, snapshots),
                         identify_snapshots(model, options, before));
}

}  // namespace strut
