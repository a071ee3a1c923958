// Levenberg-Marquardt: damping, stops, checkpoints, and the study problem.
#include "base/least_squares/levenberg_marquardt.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "base/error/input_error.h"
#include "tests/support/test_car.h"
#include "tests/train/lm_study_problem.h"
#include "tests/train/network_reference.h"
#include "train/network/growing_sample.h"
#include "train/network/network.h"

namespace strut {
namespace {

using test::kStudyStarts;
using test::StudyProblem;
using test::tolerance;
using Numbers = std::vector<double>;

/// One weight, H = 4, J'e = 2, e'e = 100 initially; the losses of the trials follow a script.
class ScriptedProblem : public LeastSquaresProblem {
 public:
  explicit ScriptedProblem(Numbers losses) : losses_(std::move(losses)) {}
  std::size_t weight_count() const override { return 1; }
  double residual_count() const override { return 1.0; }
  double calc_gram(const double*, int, double* h, double* gradient) override {
    *h = 4.0;
    *gradient = 2.0;
    return loss_;
  }
  double calc_loss(const double*) override {
    const double loss = next_ < losses_.size() ? losses_[next_++] : 1e9;
    if (loss < loss_) loss_ = loss;
    return loss;
  }

 private:
  Numbers losses_;
  std::size_t next_ = 0;
  double loss_ = 100.0;
};

/// mu at the start of each epoch, until the script ends.
Numbers run_script(const Numbers& losses, const LevenbergMarquardtOptions& options) {
  ScriptedProblem problem(losses);
  LevenbergMarquardt solver(problem, nullptr, options);
  solver.start({0.0});
  Numbers damping;
  solver.run([&](const EpochRecord& record, const LevenbergMarquardtState&) {
    damping.push_back(record.damping);
  });
  return damping;
}

TEST_CASE("The trainlm rule multiplies by ten and divides by ten", "[unit]") {
  LevenbergMarquardtOptions options;
  options.rule = DampingRule::kTrainlm;
  // Accepted; two rejected, accepted; equal is rejected, accepted; then nothing helps.
  const Numbers damping = run_script({90.0, 95.0, 91.0, 80.0, 80.0, 70.0}, options);
  const Numbers truth{1e-3, 1e-4, 1e-3, 1e-3};
  REQUIRE(damping.size() == truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    CHECK(damping[i] == Approx(truth[i]).epsilon(tolerance(1e-14)));
  }
}

TEST_CASE("Nielsen's rule follows the gain ratio", "[unit]") {
  LevenbergMarquardtOptions options;
  options.first_damping = 0.25;  // a fraction of H = 4: mu = 1
  // v = -2 / (4 + mu); predicted decrease v (mu v - 2).
  const auto predict = [](double mu) {
    const double v = -2.0 / (4.0 + mu);
    return v * (mu * v - 2.0);
  };
  Numbers truth{1.0};
  Numbers losses;
  double loss = 100.0, mu = 1.0;
  // Accepted with ratio 1, 0.5, 0.1, 0.7; two rejections before the third, one before the last.
  for (const double ratio : {1.0, 0.5, 0.1, 0.7}) {
    if (ratio == 0.1) {
      losses.insert(losses.end(), {loss + 1.0, std::nan("")});
      mu *= 2.0 * 4.0;
    } else if (ratio == 0.7) {
      losses.push_back(loss);
      mu *= 2.0;  // nu starts anew
    }
    loss -= ratio * predict(mu);
    losses.push_back(loss);
    mu *= std::max(1.0 / 3.0, 1.0 - std::pow(2.0 * ratio - 1.0, 3));
    truth.push_back(mu);
  }
  const Numbers damping = run_script(losses, options);
  REQUIRE(damping.size() == truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    // The ratio is a difference of losses near 100: 1e-14 of them is 1e-13 of it.
    CHECK(damping[i] == Approx(truth[i]).epsilon(tolerance(1e-11)));
  }
}

TEST_CASE("Each stop reason ends a training", "[unit]") {
  const auto find_reason = [](LevenbergMarquardtOptions options, double first_loss = 90.0) {
    ScriptedProblem problem({first_loss, 80.0, 70.0, 60.0});
    LevenbergMarquardt solver(problem, nullptr, options);
    solver.start({0.0});
    return solver.run().reason;
  };
  LevenbergMarquardtOptions options;
  CHECK(find_reason(options) == StopReason::kDamping);
  options.epochs = 2;
  CHECK(find_reason(options) == StopReason::kEpochs);
  options.goal = 95.0;
  CHECK(find_reason(options) == StopReason::kGoal);
  options.goal = 0.0;
  options.min_gradient = 4.0;  // 2 |J'e|
  CHECK(find_reason(options) == StopReason::kGradient);
  options.min_gradient = 0.0;
  options.seconds = 0.0;
  CHECK(find_reason(options) == StopReason::kTime);
}

TEST_CASE("A start with a loss that is not finite is reported, not trained", "[unit]") {
  const NetworkShape shape({1, 1});
  MemorySource source(1, {1.0, 2.0}, 1, {1.0, 2.0});
  NetworkProblem problem(shape, source);
  LevenbergMarquardt solver(problem, nullptr, {});
  solver.start({1e300, 1.0});
  CHECK(solver.run().reason == StopReason::kNotFinite);
  CHECK_THROWS_AS(solver.start({1.0}), InputError);
}

TEST_CASE("An option out of range is reported by name", "[unit]") {
  const auto check = [](auto change, const std::string& field) {
    LevenbergMarquardtOptions options;
    change(options);
    CHECK_THROWS_WITH(options.validate(), Catch::StartsWith(field));
  };
  using Options = LevenbergMarquardtOptions;
  check([](Options& o) { o.first_damping = -1.0; }, "first_damping: -1");
  check([](Options& o) { o.damping_increase = 1.0; }, "damping_increase: 1");
  check([](Options& o) { o.damping_decrease = 1.0; }, "damping_decrease: 1");
  check([](Options& o) { o.max_damping = std::nan(""); }, "max_damping: nan");
  check([](Options& o) { o.max_acceleration = -1.0; }, "max_acceleration: -1");
  check([](Options& o) { o.epochs = -1; }, "epochs: -1");
  check([](Options& o) { o.max_failures = 0; }, "max_failures: 0");
  check([](Options& o) { o.threads = 0; }, "threads: 0");
  CHECK_THROWS_AS((GrowingSampleOptions{0, 1.0}.validate()), InputError);
}

/// A small noisy regression that overfits soon: 90 training rows, 40 validation rows.
struct SmallTraining {
  SmallTraining()
      : shape({2, 8, 5, 2}),
        source(make_rows(90, 30)),
        validation_source(make_rows(40, 40)),
        problem(shape, source),
        validation(shape, validation_source) {}

  static MemorySource make_rows(std::size_t count, int seed) {
    Numbers x = test::make_uniform(2 * count, seed), t = test::make_uniform(2 * count, seed + 1);
    for (std::size_t i = 0; i < count; ++i) {
      t[2 * i] = std::sin(2.0 * x[2 * i]) + 0.1 * t[2 * i];
      t[2 * i + 1] = x[2 * i] * x[2 * i + 1] + 0.1 * t[2 * i + 1];
    }
    return {2, std::move(x), 2, std::move(t)};
  }

  NetworkShape shape;
  MemorySource source, validation_source;
  NetworkProblem problem, validation;
};

TEST_CASE("Validation failures end a training with the weights of the validation minimum",
          "[unit]") {
  SmallTraining small;
  LevenbergMarquardtOptions options;
  options.max_failures = 4;
  LevenbergMarquardt solver(small.problem, &small.validation, options);
  solver.start(make_nguyen_widrow_weights(small.shape, {}, 1));
  Numbers seen, best;
  const TrainingSummary summary =
      solver.run([&](const EpochRecord& record, const LevenbergMarquardtState& state) {
        if (seen.empty() || record.validation < *std::min_element(seen.begin(), seen.end())) {
          best = state.weights;
        }
        seen.push_back(record.validation);
      });
  CHECK(summary.reason == StopReason::kValidation);
  const auto minimum = std::min_element(seen.begin(), seen.end());
  CHECK(summary.best_epoch == minimum - seen.begin());
  CHECK(seen.end() - minimum == 1 + options.max_failures);
  CHECK(summary.best_validation == *minimum);
  CHECK(summary.weights == best);
  CHECK(summary.make_line().find("validation failures") != std::string::npos);
  CHECK(summary.make_report().find("factorizations") != std::string::npos);
}

bool is_same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

/// True if two states agree in every bit except for times.
bool is_same(const LevenbergMarquardtState& a, const LevenbergMarquardtState& b) {
  return a.weights == b.weights && a.epoch == b.epoch && a.damping == b.damping &&
         a.growth == b.growth && a.scale == b.scale && is_same(a.validation, b.validation) &&
         is_same(a.best_validation, b.best_validation) && a.best_epoch == b.best_epoch &&
         a.best_weights == b.best_weights && a.failures == b.failures && a.trials == b.trials &&
         a.stop == b.stop;
}

TEST_CASE("A training resumed at any epoch ends with the same bits", "[unit][property]") {
  for (const DampingRule rule : {DampingRule::kGainRatio, DampingRule::kTrainlm}) {
    for (const DampingScale scale : {DampingScale::kIdentity, DampingScale::kLargestDiagonal}) {
      LevenbergMarquardtOptions options;
      options.rule = rule;
      options.scale = scale;
      options.epochs = 25;
      SmallTraining small;
      LevenbergMarquardt solver(small.problem, &small.validation, options);
      solver.start(make_nguyen_widrow_weights(small.shape, {}, 2));
      std::vector<LevenbergMarquardtState> states;
      solver.run([&](const EpochRecord&, const LevenbergMarquardtState& state) {
        states.push_back(state);
      });
      REQUIRE(states.size() > 5);
      for (const LevenbergMarquardtState& state : states) {
        SmallTraining other;
        LevenbergMarquardt resumed(other.problem, &other.validation, options);
        resumed.restore(state);
        resumed.run();
        INFO("epoch " << state.epoch);
        CHECK(is_same(resumed.state(), solver.state()));
      }
    }
  }
}

TEST_CASE("A growing sample resumed at any epoch ends with the same bits", "[unit][property]") {
  LevenbergMarquardtOptions options;
  options.epochs = 30;
  GrowingSampleOptions growing;
  growing.first_rows = 10;
  growing.growth = 2.0;
  SmallTraining small;
  GrowingSample training(small.problem, &small.validation, options, growing);
  training.start(make_nguyen_widrow_weights(small.shape, {}, 3));
  std::vector<GrowingSampleState> states{training.save()};
  while (training.step()) states.push_back(training.save());
  CHECK(states.front().rows == 10);
  CHECK(states.back().rows == 90);
  for (const GrowingSampleState& state : states) {
    SmallTraining other;
    GrowingSample resumed(other.problem, &other.validation, options, growing);
    resumed.restore(state);
    resumed.run();
    CHECK(is_same(resumed.state(), training.state()));
  }
  CHECK_THROWS_AS(training.restore({states.front().training, 91}), InputError);
}

TEST_CASE("A sample on which no step succeeds any more is grown and trained further", "[unit]") {
  LevenbergMarquardtOptions options;
  options.epochs = 5;
  GrowingSampleOptions growing;
  growing.first_rows = 10;
  SmallTraining small;
  GrowingSample training(small.problem, nullptr, options, growing);
  training.start(make_nguyen_widrow_weights(small.shape, {}, 3));
  GrowingSampleState stuck = training.save();
  stuck.training.damping = 2.0 * options.max_damping;
  training.restore(stuck);
  CHECK(training.run().reason == StopReason::kEpochs);
  CHECK(training.rows() > 10);
}

TEST_CASE("The number of threads does not change a bit of a training",
          "[unit][property][threads]") {
  const StudyProblem study(std::string(STRUT_SOURCE_DIR) + "/tests/data/lm_problem");
  LevenbergMarquardtState first;
  for (const int threads : {1, 2, 3}) {
    MemorySource rows = study.make_training();
    NetworkProblemOptions problem_options;
    problem_options.threads = threads;
    NetworkProblem problem(StudyProblem::make_shape(), rows, problem_options);
    LevenbergMarquardtOptions options;
    options.epochs = 3;
    options.threads = threads;
    LevenbergMarquardt solver(problem, nullptr, options);
    solver.start(study.read_start("1"));
    solver.run();
    if (threads == 1) first = solver.state();
    CHECK(is_same(solver.state(), first));
  }
}

/// Trains the study problem.
class Study {
 public:
  Study()
      : data_(std::string(STRUT_SOURCE_DIR) + "/tests/data/lm_problem"),
        rows_(data_.make_training()),
        validation_rows_(data_.make_validation()) {
    // From some starts the validation loss stagnates for a while near the goal.
    options.max_failures = 20;
  }

  /// Number of epochs until the validation loss is at most `goal`; -1 if it is never reached.
  template <class Solver = LevenbergMarquardt>
  int train(const std::string& start, double goal) {
    NetworkProblem problem(StudyProblem::make_shape(), rows_, problem_options);
    NetworkProblem validation(StudyProblem::make_shape(), validation_rows_);
    Solver solver(problem, &validation, options);
    solver.start(data_.read_start(start));
    while (solver.step()) {
      if (solver.state().validation <= goal) return solver.state().epoch;
    }
    return -1;
  }

  template <class Solver>
  void check_all_starts(int max_epochs) {
    for (const char* start : kStudyStarts) {
      const int epochs = train<Solver>(start, 1e-6);
      INFO("start " << start << " epochs " << epochs);
      CHECK(epochs > 0);
      CHECK(epochs <= max_epochs * tolerance(1.0));
    }
  }

  LevenbergMarquardtOptions options;
  NetworkProblemOptions problem_options;

 private:
  StudyProblem data_;
  MemorySource rows_, validation_rows_;
};

TEST_CASE("The study problem is solved to 1e-6 from all seven starts", "[reference]") {
  // Measured 28 to 39; other instruction sets round differently.
  Study().check_all_starts<LevenbergMarquardt>(60);
}

TEST_CASE("A growing sample reaches the same solution of the study problem", "[reference]") {
  Study().check_all_starts<GrowingSample>(80);
}

TEST_CASE("A sampled H comes close to the solution of the study problem", "[reference]") {
  Study study;
  study.problem_options.gram_rows = 700;
  for (const char* start : {"1", "x0"}) {
    const int epochs = study.train(start, 1e-5);
    INFO("start " << start << " epochs " << epochs);
    CHECK(epochs > 0);
    CHECK(epochs <= 200 * tolerance(1.0));
  }
}

// Three other implementations of trainlm's documented rule (explicit Jacobian in NumPy and in C++,
// structured in C++) took 80 epochs from this start to 1e-5, and 233 to 1e-6.
TEST_CASE("The trainlm rule takes as many epochs as other implementations of it", "[reference]") {
  Study study;
  study.options.rule = DampingRule::kTrainlm;
  CHECK(std::abs(study.train("x0", 1e-5) - 80) <= 2 * tolerance(1.0));
}

}  // namespace
}  // namespace strut
