// Runs a table of trainings (networks, sample counts, seeds) in parallel, each on one thread.
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "train/train_network.h"

namespace strut {

struct TableTraining {
  std::string name;            // name of the model's file, without extension
  std::filesystem::path data;  // sweep folder, shard or merged file
  std::int64_t cases = 0;      // approximate number, to start longer trainings first
  TrainingRequest request;     // threads: 1
};

struct TrainingTableOptions {
  std::filesystem::path folder;  // folder of the models, NAME.h5; must exist
  int threads = 1;               // number of parallel trainings; no result depends on it
  NamedTexts provenance;         // attributes of every model
};

/// Progress of a table; other threads may read it meanwhile.
struct TrainingTableProgress {
  std::atomic<std::size_t> total{0}, trained{0}, kept{0};
  /// Work done and total work, in the units of estimate_epoch_work; kept models are excluded.
  std::atomic<double> work_done{0.0}, work{0.0};
};

struct TrainingTableSummary {
  bool stopped = false;
  std::size_t trained = 0, kept = 0;
  std::vector<std::string> notes;  // for the user: models that were replaced, and why
};

/// Approximate floating-point operations of one epoch; trainings are sorted by it.
double estimate_epoch_work(const TableTraining& training);

/// Returns how an existing model differs from the one that `training` would make, for example
/// "seed = 2, not 1"; empty if it does not.
std::string find_difference(const TrainedModel& model, const Training& training,
                            const TrainingRequest& request);

/// Trains the models that the folder lacks, longest trainings first. A model of the same data and
/// options is kept; any other one, or an unreadable one, is trained anew. Once `halt` is true (any
/// thread may set it), drops the current trainings and returns. Throws InputError, which names the
/// training, for invalid data or options; EnvironmentError if a model cannot be written. Models
/// written before stay.
TrainingTableSummary run_training_table(const std::vector<TableTraining>& trainings,
                                        const TrainingTableOptions& options,
                                        TrainingTableProgress& progress, std::atomic<bool>& halt);

}  // namespace strut
