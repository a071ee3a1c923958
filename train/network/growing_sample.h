// Levenberg-Marquardt on a sample of the rows that grows until it is all of them.
//
// Far from the solution a few rows tell the step as well as all do. So training starts on the first
// rows of the source (which must stand in random order) and takes more as soon as what a step
// gains is no longer told from chance; the end is exact training on all rows. After R. H. Byrd,
// G. M. Chin, J. Nocedal, Y. Wu, Math. Programming 134 (2012) 127.
#pragma once

#include <cstddef>

#include "base/least_squares/levenberg_marquardt.h"
#include "train/network/network_problem.h"

namespace strut {

struct GrowingSampleOptions {
  /// Rows of the first sample, all of them at most: then this is exact training from the start. 0:
  /// as many as give two residuals a weight, fewer of which a network fits by heart.
  std::size_t first_rows = 0;
  /// Factor by which a sample grows.
  double growth = 3.0;

  /// Throws InputError naming the field, its value and what is allowed.
  void validate() const;
};

/// Everything that such a training is between two epochs.
struct GrowingSampleState {
  LevenbergMarquardtState training;
  std::size_t rows = 0;
};

class GrowingSample {
 public:
  /// `problem` and `validation` (may be null) must outlive this; `problem`'s rows are set by it.
  /// Throws InputError for bad options.
  GrowingSample(NetworkProblem& problem, LeastSquaresProblem* validation,
                const LevenbergMarquardtOptions& options, const GrowingSampleOptions& growing = {});

  void start(const std::vector<double>& weights);
  void restore(const GrowingSampleState& state);

  /// Runs one epoch. A step that raises the loss of as many rows again, which it has not seen, is
  /// undone, and the sample grows; it also grows when a step's predicted decrease is below the
  /// standard error of the decrease on those rows, and when training on the sample stops by itself.
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
