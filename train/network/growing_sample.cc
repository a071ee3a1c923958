#include "train/network/growing_sample.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error/input_error.h"

namespace strut {

void GrowingSampleOptions::validate() const {
  if (!(growth > 1.0) || !std::isfinite(growth)) {
    throw InputError(fmt::format("growth: {:f}; allowed: above 1", growth));
  }
}

GrowingSample::GrowingSample(NetworkProblem& problem, LeastSquaresProblem* validation,
                             const LevenbergMarquardtOptions& options,
                             const GrowingSampleOptions& growing)
    : problem_(&problem), options_(growing), training_(problem, validation, options) {
  options_.validate();
}

void GrowingSample::start(const std::vector<double>& weights) {
  const auto outputs = static_cast<std::size_t>(problem_->shape().outputs());
  const std::size_t wanted = options_.first_rows > 0
                                 ? options_.first_rows
                                 : (2 * problem_->weight_count() + outputs - 1) / outputs;
  rows_ = std::min(wanted, problem_->source_rows());
  training_.start(weights);
}

void GrowingSample::restore(const GrowingSampleState& state) {
  if (state.rows < 1 || state.rows > problem_->source_rows()) {
    throw InputError(fmt::format("training: a sample of {} rows; allowed: 1 to {}", state.rows,
                                 problem_->source_rows()));
  }
  rows_ = state.rows;
  training_.restore(state.training);
}

bool GrowingSample::step() {
  problem_->set_rows(rows_);
  if (rows_ == problem_->source_rows()) return training_.step();
  const LevenbergMarquardtState before = training_.state();
  if (training_.step()) {
    judge(before);
    return true;
  }
  const StopReason reason = training_.state().stop;
  if (reason == StopReason::kEpochs || reason == StopReason::kTime ||
      reason == StopReason::kNotFinite) {
    return false;
  }
  grow(training_.state());
  return true;
}

/// Tests the last step on unseen rows; grows the sample and undoes the step where necessary.
void GrowingSample::judge(const LevenbergMarquardtState& before) {
  const std::size_t unseen = std::min(rows_, problem_->source_rows() - rows_);
  LevenbergMarquardtState after = training_.state();
  const RowStatistics change =
      problem_->calc_loss_change(before.weights.data(), after.weights.data(), rows_, unseen);
  if (change.mean > 0.0) {
    LevenbergMarquardtState undone = before;
    undone.epoch = after.epoch;
    undone.trials = after.trials;
    undone.seconds = after.seconds;
    grow(undone);
  } else if (training_.last_prediction() < change.error * static_cast<double>(rows_)) {
    grow(after);
  }
}

/// Continues from `state` with more rows.
void GrowingSample::grow(LevenbergMarquardtState state) {
  const double wanted = std::ceil(static_cast<double>(rows_) * options_.growth);
  const std::size_t all = problem_->source_rows();
  // A sample of nearly all rows is not worth a stage of its own.
  rows_ = wanted < 0.75 * static_cast<double>(all) ? static_cast<std::size_t>(wanted) : all;
  if (state.stop == StopReason::kDamping) {
    // The damping bound was reached on the old rows; on the new ones training would stop at once.
    state.damping = 0.0;
    state.growth = 2.0;
  }
  state.stop = StopReason::kNone;
  state.failures = 0;
  training_.restore(state);
}

TrainingSummary GrowingSample::run(const EpochCallback& callback) {
  bool running = true;
  while (running) {
    running = step();
    if (callback) callback(training_.last_record(), training_.state());
  }
  return training_.summarize();
}

}  // namespace strut
