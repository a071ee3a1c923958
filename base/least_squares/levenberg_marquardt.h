// Levenberg-Marquardt: minimizes e'e by steps v with (H + mu D) v = -J'e, H = J'J.
//
// K. Levenberg (1944), D. W. Marquardt (1963); the sources of the damping rules and of the
// acceleration stand at their options.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "base/least_squares/damped_system.h"
#include "base/least_squares/least_squares.h"

namespace strut {

enum class DampingRule {
  /// By the ratio of actual to predicted decrease: an accepted step multiplies mu by
  /// max(1/3, 1 - (2 ratio - 1)^3), a rejected one by nu = 2, 4, 8, ... H. B. Nielsen,
  /// IMM-REP-1999-05, Technical University of Denmark.
  kGainRatio,
  /// As MATLAB documents for trainlm: mu is multiplied by damping_increase until the loss falls,
  /// then by damping_decrease.
  kTrainlm,
};

enum class DampingScale {
  kIdentity,         // D = I (Levenberg, trainlm): for networks, whose weights have one scale
  kDiagonal,         // D = diag(H) (Marquardt): for parameters of different units
  kLargestDiagonal,  // D = largest diag(H) so far (J. J. More, 1978): shorter steps off plateaus
};

struct LevenbergMarquardtOptions {
  DampingRule rule = DampingRule::kGainRatio;
  DampingScale scale = DampingScale::kIdentity;

  /// Adds the second-order term of the path (M. K. Transtrum, J. P. Sethna, arXiv 1201.5885) to a
  /// step where the problem has second derivatives. Each step costs one more back substitution and
  /// one more pass over the residuals. Only with kGainRatio; trainlm has no such term.
  bool accelerate = true;
  /// Maximum of 2 |a| / |v| for a step v + a, by Transtrum and Sethna; longer corrections are
  /// rejected untried.
  double max_acceleration = 0.75;

  /// Initial mu; 0 selects the default of the rule. kGainRatio: relative to the largest element of
  /// diag(H) (to D with the other scales); default 0.1, within the 1e-3 to 1 that Nielsen advises
  /// for uncertain starts. kTrainlm: absolute; default 1e-3 as in trainlm.
  double first_damping = 0.0;
  double damping_increase = 10.0;  // kTrainlm only, its default
  double damping_decrease = 0.1;   // kTrainlm only, its default
  /// Maximum of mu, beyond which the search stops: trainlm's default (with kDiagonal relative to
  /// D).
  double max_damping = 1e10;

  int epochs = 1000;                                         // accepted steps, trainlm's default
  double seconds = std::numeric_limits<double>::infinity();  // s; checked once per epoch
  double goal = 0.0;           // for e'e / residual_count(), trainlm's default
  double min_gradient = 1e-7;  // for |2 J'e / residual_count()|, trainlm's default
  int max_failures = 6;        // epochs without a new validation minimum, trainlm's default

  int threads = 1;  // for the factorization; no result depends on it

  /// Throws InputError naming the field, its value and what is allowed.
  void validate() const;
};

enum class StopReason {
  kNone,
  kEpochs,
  kTime,
  kGoal,
  kGradient,
  kDamping,
  kValidation,
  kNotFinite
};
/// Name for reports: "epochs", "validation failures", ...
const char* get_name(StopReason reason);

/// The state of the search at an epoch, before its step.
struct EpochRecord {
  int epoch = 0;
  double loss = 0.0;        // e'e / residual_count()
  double validation = 0.0;  // the same for the validation rows; NaN without them
  double gradient = 0.0;    // |2 J'e / residual_count()|
  double damping = 0.0;     // mu of the first trial step
};

/// The complete state of a training between two epochs: a restored training continues bit for bit.
struct LevenbergMarquardtState {
  std::vector<double> weights;
  int epoch = 0;                 // steps taken
  double damping = 0.0;          // mu; 0: not set yet
  double growth = 2.0;           // nu of Nielsen's rule
  std::vector<double> scale;     // D; empty: not set yet
  double validation = 0.0;       // at `weights`; NaN without validation
  double best_validation = 0.0;  // minimum so far
  int best_epoch = 0;            // epoch of the minimum
  std::vector<double> best_weights;
  int failures = 0;      // epochs since the minimum
  long trials = 0;       // factorizations so far
  double seconds = 0.0;  // s, time spent so far
  StopReason stop = StopReason::kNone;
};

struct TrainingSummary {
  StopReason reason = StopReason::kNone;
  /// Weights at the validation minimum; without validation rows the last ones.
  std::vector<double> weights;
  EpochRecord last;              // the last epoch
  int best_epoch = 0;            // epoch of `weights`
  double best_validation = 0.0;  // NaN without validation rows
  long trials = 0;               // factorizations
  double seconds = 0.0;          // s

  std::string make_line() const;
  std::string make_report() const;
};

/// Called with each epoch's record and the state before its step.
using EpochCallback = std::function<void(const EpochRecord&, const LevenbergMarquardtState&)>;

class LevenbergMarquardt {
 public:
  /// `validation` may be null. Both problems must outlive this. Throws InputError for bad options.
  LevenbergMarquardt(LeastSquaresProblem& problem, LeastSquaresProblem* validation,
                     const LevenbergMarquardtOptions& options,
                     const CholeskyKernel& kernel = get_cholesky_kernel());

  /// Starts at these weights. Throws InputError for a wrong number of weights.
  void start(const std::vector<double>& weights);
  /// Continues from a state of the same problem and options.
  void restore(const LevenbergMarquardtState& state);

  /// Runs one epoch. False once the search has stopped; state().stop is the reason.
  bool step();
  /// Runs epochs until the search stops.
  TrainingSummary run(const EpochCallback& callback = {});

  const LevenbergMarquardtState& state() const { return state_; }
  const EpochRecord& last_record() const { return record_; }
  /// Decrease of e'e that the last step's linear model predicted.
  double last_prediction() const { return prediction_; }
  TrainingSummary summarize() const;

 private:
  void begin_epoch();
  StopReason check_stops(double seconds) const;
  void update_scale();
  bool find_step();
  bool calc_step(double* predicted);
  bool accelerate();
  void accept(double loss, double predicted);
  void reject();
  void update_validation();

  LeastSquaresProblem* problem_;
  LeastSquaresProblem* validation_;
  LevenbergMarquardtOptions options_;
  DampedSystem system_;
  LevenbergMarquardtState state_;
  EpochRecord record_;
  double loss_ = 0.0;  // e'e at the weights
  double prediction_ = 0.0;
  std::vector<double> h_, gradient_, velocity_, acceleration_, trial_;
  EpochCallback callback_;
};

}  // namespace strut
