// Identification by a network from readings at one instant.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "identify/identified.h"
#include "io/store/column_map.h"
#include "train/model/identifier.h"
#include "train/model/model_file.h"

namespace strut {

struct SnapshotOptions {
  std::vector<double> noise;  // 1 sigma of each of the model's inputs, in its unit; 0: exact
  bool extrapolate = false;   // also give values outside of the training range
};

/// Snapshots, one value for each of a model's inputs.
struct Snapshots {
  std::vector<double> rows;          // snapshot by snapshot
  std::vector<std::string> sources;  // file and line of each snapshot: "drive.csv:12"
};

/// Reads one snapshot per row of each file; with `event_time` [s] one per file, a history,
/// interpolated linearly between the two samples around that time; `map`: the files' columns.
/// Throws InputError that names
/// the file and its fault; also for a history without `event_time`.
Snapshots read_snapshots(const TrainedModel& model, const std::vector<std::filesystem::path>& files,
                         std::optional<double> event_time, const ColumnMap& map = {});

/// Identifies the parameters from one snapshot; `inputs` holds one value for each of the model's.
///
/// An input is outside if it exceeds the training range by more than 1.96 sigma of its noise;
/// values are then given only with `extrapolate`, and intervals never. A parameter is outside as
/// is_parameter_in_range defines it. The half width is, to first order,
///
///   sqrt(ci95^2 + 1.96^2 sum_i (d parameter / d input_i  sigma_i)^2)
///
/// that is, the model's own interval and independent noise of the inputs.
IdentifiedRow identify_snapshot(const TrainedModel& model, const Identifier& identifier,
                                const SnapshotOptions& options, const double* inputs);

/// Identifies each of the snapshots.
std::vector<IdentifiedRow> identify_snapshots(const TrainedModel& model,
                                              const SnapshotOptions& options,
                                              const Snapshots& snapshots);

}  // namespace strut
