// A trained network as a file, with everything needed to use it, judge it and repeat it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/least_squares/levenberg_marquardt.h"
#include "io/format/named_texts.h"
#include "io/store/shard.h"
#include "train/data/dataset_source.h"
#include "train/data/noise.h"
#include "train/data/normalizer.h"
#include "train/data/transform.h"

namespace strut {

struct TrainedModel {
  std::vector<int> sizes;  // inputs, hidden layers, outputs
  std::vector<double> weights;
  std::vector<ColumnInfo> inputs, targets;
  Normalizer input_map{0}, target_map{0};
  /// Per target half the width of the 95 % interval, in the target's unit, as calc_ci95 finds it
  /// (train/model/interval.h); infinite where too few cases were left to tell.
  std::vector<double> ci95;

  std::optional<NoiseModel> noise;        // that the inputs, channels of a snapshot, carried
  std::optional<WindowTransform> window;  // from a record to the inputs

  // The data.
  std::string plan_hash;
  std::int64_t samples = 0;  // asked for; 0: all
  std::int64_t usable = 0, skipped = 0;
  SplitChoice split;

  // The training.
  NamedTexts options;
  std::vector<EpochRecord> record;
  StopReason stop = StopReason::kNone;
  int best_epoch = 0;  // of the weights
  double best_validation = 0.0;
  double seconds = 0.0;

  NamedTexts provenance;  // attributes of the file
};

/// Appears whole or not at all; replaces a file of that name. Throws EnvironmentError.
void write_trained_model(const std::filesystem::path& path, const TrainedModel& model);

/// Throws InputError that names the file and what is wrong: no model, an unknown version, a
/// checksum or shapes that do not fit. Provenance is not read.
TrainedModel read_trained_model(const std::filesystem::path& path);

}  // namespace strut
