// Training of the network 4-27-19-11-4 (935 weights) on 1,400 rows: time of an iteration and of its
// parts, time to the solution from seven starts, time of a prediction, memory; GSL and Ceres for
// comparison if they are installed. Results: docs/design/0007-levenberg-marquardt.md.
//
//   lm_benchmark [REPETITIONS]
//
// Each time is the minimum of many. "spin" is the simultaneous speed of a fixed chain of
// operations, relative to the idle machine: below 0.95 other processes were running.
#include <sys/resource.h>

#include <cstdio>
#include <cstdlib>
#include <functional>

#include "base/least_squares/damped_system.h"
#include "benchmarks/cpu_time.h"
#include "benchmarks/lm_peers.h"
#include "jobs/cli/clock.h"
#include "jobs/cli/machine.h"
#include "tests/train/lm_study_problem.h"
#include "train/network/growing_sample.h"
#include "train/network/network.h"

namespace strut {
namespace {

using test::kStudyStarts;
using test::StudyProblem;
using Numbers = std::vector<double>;

struct Timer {
  int repetitions;
  double full_spin = calibrate_spin();

  /// Returns and prints the minimum wall time of `run` [ms], with the maximum spin.
  double measure(const char* name, const std::function<void()>& run) const {
    double best = 1e9, spin = 0.0;
    for (int i = 0; i < repetitions; ++i) {
      const double start = now();
      run();
      best = std::min(best, now() - start);
      if (i % 8 == 0) spin = std::max(spin, measure_spin());
    }
    std::printf("  %-44s %9.3f ms   spin %.2f\n", name, 1e3 * best, spin / full_spin);
    return 1e3 * best;
  }
};

/// Peak memory of this process [MB].
double read_peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

/// Measures the functions of the kernel one by one, on one thread.
void measure_kernel(const Timer& timer, const NetworkShape& shape, const Numbers& weights) {
  const TrainKernel& kernel = get_train_kernel();
  constexpr std::size_t kRows = NetworkProblem::kChunkRows, kAll = 1408;
  const auto outputs = static_cast<std::size_t>(shape.outputs());
  const GramLayout layout(shape);
  Numbers a(shape.activation_rows * kRows), d((outputs * shape.delta_rows + 1) * kRows);
  Numbers sums(layout.sum_count), factors(layout.largest_factors * kSlabRows);
  const Numbers inputs(kBlockRows * static_cast<std::size_t>(shape.inputs()), 0.3);
  const auto get_block = [&](std::size_t row) { return Block{a.data() + row % kRows, kRows}; };
  for (std::size_t row = 0; row < kRows; row += kBlockRows) {
    load_inputs(shape, inputs.data(), kBlockRows, get_block(row));
  }
  timer.measure("forward", [&] {
    for (std::size_t row = 0; row < kAll; row += kBlockRows) {
      kernel.run_forward(shape, weights.data(), get_block(row));
    }
  });
  timer.measure("backward, four outputs", [&] {
    for (std::size_t row = 0; row < kAll; row += kBlockRows) {
      kernel.run_backward(shape, weights.data(), get_block(row), kBlockRows,
                          d.data() + row % kRows);
    }
  });
  const auto add_tiles = [&](auto change) {
    for (std::size_t row = 0; row < kAll; row += kRows) {
      for (GramTile tile : layout.tiles) {
        change(tile);
        kernel.add_tile(shape, tile, get_block(0), d.data(), std::min(kRows, kAll - row),
                        factors.data(), sums.data());
      }
    }
  };
  const double tiles = timer.measure("factors and products", [&] { add_tiles([](GramTile&) {}); });
  std::printf("  %-44s %9.1f Gflop/s\n", "",
              2e-6 * static_cast<double>(layout.sum_count * kAll) / tiles);
  Numbers h(weights.size() * weights.size());
  timer.measure("sums into H", [&] {
    for (const GramTile& tile : layout.tiles) store_tile(shape, tile, sums.data(), h.data());
  });
}

void measure_iteration(const Timer& timer, const StudyProblem& study, int threads) {
  std::printf("one iteration, %d thread%s\n", threads, threads > 1 ? "s" : "");
  const NetworkShape shape = StudyProblem::make_shape();
  const Numbers weights = study.read_start("0");
  MemorySource rows = study.make_training();
  NetworkProblemOptions options;
  options.threads = threads;
  NetworkProblem problem(shape, rows, options);
  Numbers h(weights.size() * weights.size()), gradient(weights.size());
  const Numbers direction(weights.size(), 0.01), scale(weights.size(), 1.0);
  double sum = timer.measure(
      "H and gradient", [&] { problem.calc_gram(weights.data(), 0, h.data(), gradient.data()); });
  if (threads == 1) measure_kernel(timer, shape, weights);
  DampedSystem system(weights.size(), threads, get_cholesky_kernel());
  sum += timer.measure("Cholesky", [&] { system.factor(h, scale, 1.0); });
  sum += 2.0 * timer.measure("back substitution (twice)", [&] {
    Numbers x = gradient;
    system.solve(x);
  });
  sum += timer.measure("second derivative", [&] {
    problem.calc_second_gradient(weights.data(), direction.data(), gradient.data());
  });
  sum += timer.measure("trial loss", [&] { problem.calc_loss(weights.data()); });
  std::printf("  %-44s %9.3f ms\n", "sum", sum);
}

template <class Solver>
void measure_solution(const char* name, Solver& solver, const Numbers& start) {
  const double begin = read_cpu_time();
  solver.start(start);
  while (solver.state().validation > 1e-6 && solver.step()) {
  }
  const LevenbergMarquardtState& state = solver.state();
  std::printf("  %-24s %5d epochs %5ld factorizations %7.3f CPU s%s\n", name, state.epoch,
              state.trials, read_cpu_time() - begin,
              state.validation > 1e-6 ? "   not reached" : "");
}

void measure_solutions(const StudyProblem& study, DampingRule rule, std::size_t gram_rows,
                       bool growing) {
  const NetworkShape shape = StudyProblem::make_shape();
  for (const char* start : kStudyStarts) {
    MemorySource rows = study.make_training(), validation_rows = study.make_validation();
    NetworkProblemOptions problem_options;
    problem_options.gram_rows = gram_rows;
    NetworkProblem problem(shape, rows, problem_options), validation(shape, validation_rows);
    LevenbergMarquardtOptions options;
    options.rule = rule;
    options.max_failures = rule == DampingRule::kTrainlm ? 6 : 20;
    options.epochs = 500;
    if (growing) {
      GrowingSample solver(problem, &validation, options);
      measure_solution(start, solver, study.read_start(start));
    } else {
      LevenbergMarquardt solver(problem, &validation, options);
      measure_solution(start, solver, study.read_start(start));
    }
  }
}

void measure_prediction(const Timer& timer, const StudyProblem& study) {
  const Predictor predictor(StudyProblem::make_shape(), study.read_start("0"));
  Numbers inputs(4, 0.1), outputs(4);
  timer.measure("1,000 predictions, in sequence", [&] {
    for (int i = 0; i < 1000; ++i) {
      predictor.predict(inputs.data(), outputs.data());
      inputs[0] = 0.1 * outputs[0];
    }
  });
}

}  // namespace
}  // namespace strut

int main(int argc, char** argv) {
  const strut::Timer timer{argc > 1 ? std::atoi(argv[1]) : 200};
  const strut::test::StudyProblem study(std::string(STRUT_SOURCE_DIR) + "/tests/data/lm_problem");
  std::printf("kernel %s\n", strut::get_train_kernel().isa);
  std::printf("to validation MSE 1e-6, one thread\n");
  strut::measure_solutions(study, strut::DampingRule::kGainRatio, 0, false);
  std::printf("  peak memory of the process so far %.1f MB\n", strut::read_peak_memory());
  for (const int threads : {1, 2}) strut::measure_iteration(timer, study, threads);
  strut::measure_prediction(timer, study);
  std::printf("growing sample\n");
  strut::measure_solutions(study, strut::DampingRule::kGainRatio, 0, true);
  std::printf("H from windows of 700 rows\n");
  strut::measure_solutions(study, strut::DampingRule::kGainRatio, 700, false);
  std::printf("trainlm rule, six failures, 500 epochs\n");
  strut::measure_solutions(study, strut::DampingRule::kTrainlm, 0, false);
  strut::run_peers(study);
}
