// One training from a dataset to a model.
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

struct TrainingRequest {
  RowChoice rows;
  /// A window of the histories in place of the snapshot; asks for `noise`.
  std::optional<WindowChoice> window;
  std::optional<NoiseModel> noise;  // of rows.inputs
  std::vector<int> hidden = {27, 19, 11};
  SplitChoice split;
  std::uint64_t seed = 1;  // of the start weights (Nguyen-Widrow)
  bool allow_few = false;  // train with fewer equations than weights
  LevenbergMarquardtOptions options;
  /// First epochs on a sample of the rows; without, every epoch takes all.
  std::optional<GrowingSampleOptions> growing;
  NetworkProblemOptions problem;
  RowStoreOptions store;
};

class Training {
 public:
  /// Reads the dataset, which must have been opened for histories where a window is asked for.
  /// Throws InputError, see read_usable_rows, split_rows and make_window_rows, and where the
  /// training rows give fewer equations (rows x outputs) than the network has weights.
  Training(Dataset& dataset, const TrainingRequest& request);

  /// Goes on from a checkpoint; limits (epochs, goal, failures, ...) are those of the request.
  /// `path` stands in messages. Throws InputError where it is one of another training.
  void resume(const std::filesystem::path& path, const Checkpoint& checkpoint);

  /// Runs one epoch; false once it has stopped.
  bool step();

  const TrainingRows& data() const { return data_; }
  const NetworkShape& shape() const { return shape_; }
  const LevenbergMarquardtState& state() const { return training_->state(); }
  const std::vector<EpochRecord>& record() const { return record_; }
  /// Rows of the sample at hand.
  std::size_t rows() const { return training_->rows(); }
  TrainingSummary summarize() const;

  Checkpoint make_checkpoint() const;
  /// At the validation minimum; without provenance.
  TrainedModel make_model() const;

 private:
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
