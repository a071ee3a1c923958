// Trains a model on a dataset.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "train/data/dataset_source.h"
#include "train/model/checkpoint.h"
#include "train/model/model_file.h"
#include "train/network/growing_sample.h"
#include "train/network/network_problem.h"
#include "train/window/records.h"

namespace strut {

/// Names of the damping rules, in the order of DampingRule.
inline const std::vector<std::string> kDampingRules = {"gain-ratio", "trainlm"};

struct TrainingRequest {
  RowChoice rows;
  /// A window of the histories instead of the snapshot; needs `noise`.
  std::optional<WindowChoice> window;
  std::optional<NoiseModel> noise;  // noise of rows.inputs
  std::vector<int> hidden = {27, 19, 11};
  SplitChoice split;
  std::uint64_t seed = 1;  // seed of the start weights (Nguyen-Widrow)
  bool allow_few = false;  // allow fewer equations than weights
  LevenbergMarquardtOptions options;
  /// Start on a growing sample of the rows; otherwise every epoch uses all rows.
  std::optional<GrowingSampleOptions> growing;
  NetworkProblemOptions problem;
  RowStoreOptions store;
};

/// Lists the limits that decide at which epoch a training ends.
NamedTexts describe_limits(const LevenbergMarquardtOptions& options);

class Training {
 public:
  /// Reads the dataset, which must have been opened with histories if a window is requested. Throws
  /// InputError as read_usable_rows, split_rows and make_window_rows do, and unless `allow_few` is
  /// set, if the training rows give fewer equations (rows x outputs) than the network has weights.
  Training(Dataset& dataset, const TrainingRequest& request);

  /// Resumes from a checkpoint, with the limits (epochs, goal, failures, ...) of the request.
  /// `path` is used in messages. Throws InputError if it is the checkpoint of a different training.
  void resume(const std::filesystem::path& path, const Checkpoint& checkpoint);

  /// Runs one epoch; returns false once the training has stopped.
  bool step();

  const TrainingRows& data() const { return data_; }
  const NetworkShape& shape() const { return shape_; }
  const LevenbergMarquardtState& state() const { return training_->state(); }
  const std::vector<EpochRecord>& record() const { return record_; }
  /// Number of rows of the current sample.
  std::size_t rows() const { return training_->rows(); }
  TrainingSummary summarize() const;

  Checkpoint make_checkpoint() const;
  /// The model at the validation minimum; without provenance.
  TrainedModel make_model() const;

 private:
  /// Everything that determines how the training proceeds, limits excluded.
  NamedTexts describe_start() const;

  TrainingRequest request_;
  std::string plan_hash_;
  TrainingRows data_;
  NetworkShape shape_;
  std::unique_ptr<StoreSource> train_source_, validate_source_;
  std::unique_ptr<NetworkProblem> problem_, validation_;
  std::optional<GrowingSample> training_;
  std::vector<EpochRecord> record_;
};

}  // namespace strut
