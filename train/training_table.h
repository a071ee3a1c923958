// Many trainings side by side, one thread each: a table of networks, sample counts and seeds.
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "train/train_network.h"

namespace strut {

struct TableTraining {
  std::string name;            // of the model's file, without its extension
  std::filesystem::path data;  // sweep folder, shard or merged file
  std::int64_t cases = 0;      // about so many: longer trainings begin first
  TrainingRequest request;     // threads: 1
};

struct TrainingTableOptions {
  std::filesystem::path folder;  // of the models, one `name`.h5 each; must be there
  int threads = 1;               // trainings at a time; no result depends on it
  NamedTexts provenance;         // attributes of every model
};

/// What a table has reached; read by other threads while it lasts.
struct TrainingTableProgress {
  std::atomic<std::size_t> total{0}, trained{0}, kept{0};
  /// Work done of all that is not kept, in units of one another: trainings of large networks count
  /// for more. Both exclude what is kept.
  std::atomic<double> work_done{0.0}, work{0.0};
};

struct TrainingTableSummary {
  bool stopped = false;
  std::size_t trained = 0, kept = 0;
  std::vector<std::string> notes;  // for the user: which model was there but is another, and why
};

/// Floating-point operations of one epoch, roughly: what decides which training is longest.
double estimate_epoch_work(const TableTraining& training);

/// What a model that is there differs in from one that `training` would make: "seed = 2, not 1";
/// empty where it is the same training, finished.
std::string find_difference(const TrainedModel& model, const Training& training,
                            const TrainingRequest& request);

/// Trains what the folder lacks, longest first. A model of the same data and options is kept; one
/// of others, or that cannot be read, is trained anew. Once `halt` is true (set by anybody) it
/// drops the trainings at hand and returns. Throws InputError of a training's data or options,
/// which names the training, EnvironmentError where a model cannot be written; those written before
/// stay.
TrainingTableSummary run_training_table(const std::vector<TableTraining>& trainings,
                                        const TrainingTableOptions& options,
                                        TrainingTableProgress& progress, std::atomic<bool>& halt);

}  // namespace strut
