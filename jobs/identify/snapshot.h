// Identification by a network from what was measured at one instant.
#pragma once

#include <filesystem>
#include <vector>

#include "jobs/cli/arguments.h"
#include "jobs/identify/result.h"
#include "train/model/identifier.h"
#include "train/model/model_file.h"

namespace strut {

/// What a snapshot is identified with.
struct SnapshotOptions {
  std::vector<double> noise;  // 1 sigma of each of the model's inputs, in its unit; 0: exact
  bool extrapolate = false;   // give values outside of the range trained on
};

/// An input is outside where it lies beyond the range trained on by more than 1.96 sigma of its
/// noise; then values are given only with `extrapolate`, and intervals not at all. A parameter is
/// outside as is_parameter_in_range says. The half width is
///
///   sqrt(ci95^2 + 1.96^2 sum_i (d parameter / d input_i  sigma_i)^2)
///
/// of the model's interval and of independent noise of the inputs, to first order.
/// `inputs`: one value for each of the model's.
IdentifiedRow identify_snapshot(const TrainedModel& model, const Identifier& identifier,
                                const SnapshotOptions& options, const double* inputs);

/// --set, --event-time, --noise, --extrapolate
void add_snapshot_options(Arguments& arguments);

/// Reads the files (or --set), identifies, prints and writes. Returns an exit code. Throws
/// InputError.
int identify_by_snapshot(const Arguments& arguments, const TrainedModel& model,
                         const std::vector<std::filesystem::path>& files);

}  // namespace strut
