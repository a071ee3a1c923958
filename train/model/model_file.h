// Files of trained networks, with everything needed to use, evaluate and reproduce them.
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
  /// Half width of the 95 % interval of each target, in the target's unit (calc_ci95,
  /// train/model/interval.h); infinite if there were too few validation cases.
  std::vector<double> ci95;

  std::optional<NoiseModel> noise;        // added to the inputs, channels of a snapshot
  std::optional<WindowTransform> window;  // from a record to the inputs

  // Data.
  std::string plan_hash;
  std::int64_t samples = 0;  // requested number of rows; 0: all
  std::int64_t usable = 0, skipped = 0;
  SplitChoice split;

  // Training.
  NamedTexts options;
  std::vector<EpochRecord> record;
  StopReason stop = StopReason::kNone;
  int best_epoch = 0;  // epoch of the weights
  double best_validation = 0.0;
  double seconds = 0.0;

  NamedTexts provenance;  // attributes of the file
};

/// Writes atomically; replaces an existing file. Throws EnvironmentError.
void write_trained_model(const std::filesystem::path& path, const TrainedModel& model);

/// Throws InputError, which names the file and the fault: not a model, an unknown version, a wrong
/// checksum or inconsistent shapes. Does not read provenance.
TrainedModel read_trained_model(const std::filesystem::path& path);

}  // namespace strut
