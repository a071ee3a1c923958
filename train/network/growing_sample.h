// Levenberg-Marquardt on a sample of the rows that grows until it includes all of them.
//
// Far from the solution a few rows determine a step as well as all rows do. Training therefore
// starts on the first rows of the source (which must be in random order) and adds rows as soon as
// the decrease of a step is no longer statistically significant; it ends with exact training on all
// rows. After R. H. Byrd, G. M. Chin, J. Nocedal, Y. Wu, Math. Programming 134 (2012) 127.
#pragma once

#include <cstddef>

#include "base/least_squares/levenberg_marquardt.h"
#include "train/network/network_problem.h"

namespace strut {

struct GrowingSampleOptions {
  /// Rows of the first sample; with all rows this is exact training from the start. 0: two
  /// residuals per weight, since a network memorizes fewer.
  std::size_t first_rows = 0;
  /// Factor by which a sample grows.
  double growth = 3.0;

  /// Throws InputError naming the field, its value and what is allowed.
  void validate() const;
};

/// Complete state of the training between two epochs.
struct GrowingSampleState {
  LevenbergMarquardtState training;
  std::size_t rows = 0;
};

class GrowingSample {
 public:
  /// `problem`, whose rows this sets, and `validation`, which may be null, must outlive this.
  /// Throws InputError for invalid options.
  GrowingSample(NetworkProblem& problem, LeastSquaresProblem* validation,
                const LevenbergMarquardtOptions& options, const GrowingSampleOptions& growing = {});

  void start(const std::vector<double>& weights);
  void restore(const GrowingSampleState& state);

  /// Runs one epoch; returns false once training has stopped. Each step is tested on an equal
  /// number of unseen rows: if it raises their loss, it is undone and the sample grows. The sample
  /// also grows if the predicted decrease is below the standard error of the decrease on those
  /// rows, and if training on the sample stops by itself.
  bool step();
  TrainingSummary run(const EpochCallback& callback = {});

  const LevenbergMarquardtState& state() const { return training_.state(); }
  const EpochRecord& last_record() const { return training_.last_record(); }
  GrowingSampleState save() const { return {training_.state(), rows_}; }
  std::size_t rows() const { return rows_; }

 private:
  void grow(LevenbergMarquardtState state);
  void judge(const LevenbergMarquardtState& before);

  NetworkProblem* problem_;
  GrowingSampleOptions options_;
  LevenbergMarquardt training_;
  std::size_t rows_ = 0;
};

}  // namespace strut
