// A trained network as a file, with everything needed to use it, judge it and repeat it; and a
// training halfway as a file, to go on from.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "io/shard.h"
#include "train/dataset_source.h"
#include "train/levenberg_marquardt.h"
#include "train/normalizer.h"

namespace strut {

/// (name, text) in the order of the file.
using NamedTexts = std::vector<std::pair<std::string, std::string>>;

struct Model {
  std::vector<int> sizes;  // inputs, hidden layers, outputs
  std::vector<double> weights;
  std::vector<ColumnInfo> inputs, targets;
  Normalizer input_map{0}, target_map{0};

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
void write_model(const std::filesystem::path& path, const Model& model);

/// Throws InputError that names the file and what is wrong: no model, an unknown version, a
/// checksum or shapes that do not fit. Provenance is not read.
Model read_model(const std::filesystem::path& path);

/// A training between two epochs.
struct Checkpoint {
  /// Everything that decides how it goes on.
  NamedTexts started_with;
  LevenbergMarquardtState state;
  std::vector<EpochRecord> record;
};

void write_checkpoint(const std::filesystem::path& path, const Checkpoint& checkpoint);
Checkpoint read_checkpoint(const std::filesystem::path& path);

/// Throws InputError with a line for each fact that is another in `now`.
void require_same_start(const std::filesystem::path& path, const Checkpoint& checkpoint,
                        const NamedTexts& now);

}  // namespace strut
