#include "base/least_squares/levenberg_marquardt.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/error/input_error.h"

namespace strut {
namespace {

/// Minimum of mu, below which damping has no effect; the same as trainlm's.
constexpr double kMinDamping = 1e-20;
/// Default initial mu of each rule.
constexpr double kGainRatioDamping = 0.1, kTrainlmDamping = 1e-3;

double get_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double calc_norm(const std::vector<double>& x) {
  double sum = 0.0;
  for (const double value : x) sum += value * value;
  return std::sqrt(sum);
}

/// |D^(1/2) x|
double calc_norm(const std::vector<double>& x, const std::vector<double>& scale) {
  double sum = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) sum += scale[i] * x[i] * x[i];
  return std::sqrt(sum);
}

}  // namespace

LevenbergMarquardt::LevenbergMarquardt(LeastSquaresProblem& problem,
                                       LeastSquaresProblem* validation,
                                       const LevenbergMarquardtOptions& options,
                                       const CholeskyKernel& kernel)
    : problem_(&problem),
      validation_(validation),
      options_(options),
      system_(problem.weight_count(), options.threads, kernel) {
  options_.validate();
  const std::size_t n = problem.weight_count();
  h_.resize(n * n);
  gradient_.resize(n);
  velocity_.resize(n);
  acceleration_.resize(n);
  trial_.resize(n);
}

void LevenbergMarquardt::start(const std::vector<double>& weights) {
  LevenbergMarquardtState state;
  state.weights = weights;
  state.best_weights = weights;
  state.validation = std::numeric_limits<double>::quiet_NaN();
  if (validation_ != nullptr && weights.size() == problem_->weight_count()) {
    state.validation = validation_->calc_loss(weights.data()) / validation_->residual_count();
  }
  state.best_validation = state.validation;
  restore(state);
}

void LevenbergMarquardt::restore(const LevenbergMarquardtState& state) {
  if (state.weights.size() != problem_->weight_count()) {
    throw InputError(fmt::format("training: {} start weights; the network has {}",
                                 state.weights.size(), problem_->weight_count()));
  }
  state_ = state;
}

TrainingSummary LevenbergMarquardt::run(const EpochCallback& callback) {
  callback_ = callback;
  while (step()) {
  }
  callback_ = {};
  return summarize();
}

bool LevenbergMarquardt::step() {
  if (state_.stop != StopReason::kNone) return false;
  const double start = get_seconds();
  begin_epoch();
  if (callback_) callback_(record_, state_);
  state_.stop = check_stops(state_.seconds + get_seconds() - start);
  if (state_.stop == StopReason::kNone && !find_step()) state_.stop = StopReason::kDamping;
  if (state_.stop == StopReason::kNone) {
    ++state_.epoch;
    update_validation();
  }
  state_.seconds += get_seconds() - start;
  return state_.stop == StopReason::kNone;
}

void LevenbergMarquardt::begin_epoch() {
  loss_ = problem_->calc_gram(state_.weights.data(), state_.epoch, h_.data(), gradient_.data());
  update_scale();
  const double count = problem_->residual_count();
  record_ = {state_.epoch, loss_ / count, state_.validation, 2.0 * calc_norm(gradient_) / count,
             state_.damping};
}

void LevenbergMarquardt::update_scale() {
  const std::size_t n = gradient_.size();
  const bool identity = options_.scale == DampingScale::kIdentity;
  if (state_.scale.empty()) state_.scale.assign(n, identity ? 1.0 : 0.0);
  double largest = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double diagonal = h_[i * n + i];
    largest = std::max(largest, diagonal);
    if (identity) continue;
    const double before = options_.scale == DampingScale::kDiagonal ? 0.0 : state_.scale[i];
    state_.scale[i] = std::max(before, diagonal);
    if (state_.scale[i] == 0.0) state_.scale[i] = 1.0;  // keeps a weight without effect constant
  }
  if (state_.damping == 0.0) {
    const bool by_ratio = options_.rule == DampingRule::kGainRatio;
    const double fallback = by_ratio ? kGainRatioDamping : kTrainlmDamping;
    state_.damping = (options_.first_damping > 0.0 ? options_.first_damping : fallback) *
                     (by_ratio && identity ? largest : 1.0);
  }
}

StopReason LevenbergMarquardt::check_stops(double seconds) const {
  if (!std::isfinite(loss_)) return StopReason::kNotFinite;
  if (record_.loss <= options_.goal) return StopReason::kGoal;
  if (record_.gradient <= options_.min_gradient) return StopReason::kGradient;
  if (state_.damping > options_.max_damping) return StopReason::kDamping;
  if (validation_ != nullptr && state_.failures >= options_.max_failures) {
    return StopReason::kValidation;
  }
  if (state_.epoch >= options_.epochs) return StopReason::kEpochs;
  if (seconds >= options_.seconds) return StopReason::kTime;
  return StopReason::kNone;
}

/// Raises mu until a step lowers the loss and takes that step; false where mu reaches its maximum
/// first.
bool LevenbergMarquardt::find_step() {
  while (state_.damping <= options_.max_damping) {
    ++state_.trials;
    double predicted = 0.0;
    if (calc_step(&predicted)) {
      const double loss = problem_->calc_loss(trial_.data());
      if (loss < loss_) {
        accept(loss, predicted);
        return true;
      }
    }
    reject();
  }
  return false;
}

/// Writes trial_ = weights + v + a; false where H + mu D is not positive definite or a is too long.
bool LevenbergMarquardt::calc_step(double* predicted) {
  if (!system_.factor(h_, state_.scale, state_.damping)) return false;
  for (std::size_t i = 0; i < velocity_.size(); ++i) velocity_[i] = -gradient_[i];
  system_.solve(velocity_);
  for (std::size_t i = 0; i < velocity_.size(); ++i) {
    *predicted += velocity_[i] * (state_.damping * state_.scale[i] * velocity_[i] - gradient_[i]);
    trial_[i] = state_.weights[i] + velocity_[i];
  }
  const bool accelerated = options_.accelerate && options_.rule == DampingRule::kGainRatio &&
                           problem_->has_second_derivative();
  return !accelerated || accelerate();
}

/// Adds a = -(H + mu D)^-1 J'e" / 2 to trial_; false where a is too long.
bool LevenbergMarquardt::accelerate() {
  problem_->calc_second_gradient(state_.weights.data(), velocity_.data(), acceleration_.data());
  system_.solve(acceleration_);
  for (std::size_t i = 0; i < acceleration_.size(); ++i) {
    acceleration_[i] *= -0.5;
    trial_[i] += acceleration_[i];
  }
  const double length = calc_norm(velocity_, state_.scale);
  return 2.0 * calc_norm(acceleration_, state_.scale) < options_.max_acceleration * length;
}

void LevenbergMarquardt::accept(double loss, double predicted) {
  state_.weights.swap(trial_);
  prediction_ = predicted;
  double factor = options_.damping_decrease;
  if (options_.rule == DampingRule::kGainRatio) {
    const double excess = 2.0 * (loss_ - loss) / predicted - 1.0;  // 2 ratio - 1
    factor = std::max(1.0 / 3.0, 1.0 - excess * excess * excess);
    state_.growth = 2.0;
  }
  state_.damping = std::max(kMinDamping, state_.damping * factor);
}

void LevenbergMarquardt::reject() {
  if (options_.rule == DampingRule::kGainRatio) {
    state_.damping *= state_.growth;
    state_.growth *= 2.0;
  } else {
    state_.damping *= options_.damping_increase;
  }
}

void LevenbergMarquardt::update_validation() {
  if (validation_ == nullptr) {
    state_.best_weights = state_.weights;
    state_.best_epoch = state_.epoch;
    return;
  }
  state_.validation = validation_->calc_loss(state_.weights.data()) / validation_->residual_count();
  if (state_.validation < state_.best_validation) {
    state_.best_validation = state_.validation;
    state_.best_weights = state_.weights;
    state_.best_epoch = state_.epoch;
    state_.failures = 0;
  } else {
    ++state_.failures;
  }
}

TrainingSummary LevenbergMarquardt::summarize() const {
  return {state_.stop,   state_.best_weights, record_, state_.best_epoch, state_.best_validation,
          state_.trials, state_.seconds};
}

}  // namespace strut
