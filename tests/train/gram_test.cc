// J'J, J'e and J'e" without J, against the explicit J; and their bits, independent of threads and
// storage.
#include <catch2/catch.hpp>
#include <cmath>

#include "base/error/input_error.h"
#include "base/least_squares/damped_system.h"
#include "tests/support/test_car.h"
#include "tests/train/network_reference.h"
#include "train/network/network_problem.h"

namespace strut {
namespace {

using test::calc_outputs;
using test::kShapes;
using test::make_random_rows;
using test::make_random_weights;
using test::tolerance;
using Numbers = std::vector<double>;

struct Gram {
  double loss = 0.0;
  Numbers h, gradient;
  bool operator==(const Gram&) const = default;
};

Gram calc_gram(NetworkProblem& problem, const Numbers& weights, int epoch = 0) {
  const std::size_t n = weights.size();
  Gram gram{0.0, Numbers(n * n, 0.0), Numbers(n)};
  gram.loss = problem.calc_gram(weights.data(), epoch, gram.h.data(), gram.gradient.data());
  return gram;
}

/// Inputs and targets of a source, by rows.
struct Rows {
  explicit Rows(RowSource& source)
      : count(source.row_count()),
        x(count * static_cast<std::size_t>(source.input_count())),
        t(count * static_cast<std::size_t>(source.target_count())) {
    source.read(0, count, x.data(), t.data());
  }
  std::size_t count;
  Numbers x, t;
};

/// The Gram from explicit Jacobians.
Gram calc_explicit(const NetworkShape& shape, const Numbers& weights, const Rows& rows) {
  const std::size_t n = weights.size();
  const auto in = static_cast<std::size_t>(shape.inputs());
  const auto out = static_cast<std::size_t>(shape.outputs());
  Gram gram{0.0, Numbers(n * n, 0.0), Numbers(n)};
  for (std::size_t row = 0; row < rows.count; ++row) {
    const double* x = rows.x.data() + row * in;
    const Numbers y = calc_outputs(shape, weights, x);
    const auto j = test::calc_jacobian(shape, weights, x);
    for (std::size_t k = 0; k < out; ++k) {
      const double e = y[k] - rows.t[row * out + k];
      gram.loss += e * e;
      for (std::size_t c = 0; c < n; ++c) {
        gram.gradient[c] += j[k][c] * e;
        for (std::size_t r = c; r < n; ++r) gram.h[c * n + r] += j[k][c] * j[k][r];
      }
    }
  }
  return gram;
}

double calc_max(const Numbers& values) {
  double max = 0.0;
  for (const double value : values) max = std::max(max, std::fabs(value));
  return max;
}

double calc_max_difference(const Numbers& a, const Numbers& b) {
  REQUIRE(a.size() == b.size());
  double max = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) max = std::max(max, std::fabs(a[i] - b[i]));
  return max;
}

TEST_CASE("The reference Jacobian agrees with differences", "[unit]") {
  for (const auto& sizes : kShapes) {
    const NetworkShape shape(sizes);
    const Numbers weights = make_random_weights(shape, 1);
    const Numbers x = test::make_uniform(static_cast<std::size_t>(shape.inputs()), 2);
    const auto j = test::calc_jacobian(shape, weights, x.data());
    constexpr double kStep = 1e-5;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      Numbers up = weights, down = weights;
      up[i] += kStep;
      down[i] -= kStep;
      const Numbers y_up = calc_outputs(shape, up, x.data());
      const Numbers y_down = calc_outputs(shape, down, x.data());
      for (std::size_t k = 0; k < j.size(); ++k) {
        // h^2 of curvature, eps / h of rounding: both 1e-10 of quantities of order one.
        CHECK(std::fabs((y_up[k] - y_down[k]) / (2.0 * kStep) - j[k][i]) <= tolerance(1e-9));
      }
    }
  }
}

TEST_CASE("The structured Gram equals that of the explicit Jacobian", "[unit]") {
  for (const TrainKernel& kernel : list_train_kernels()) {
    for (const auto& sizes : kShapes) {
      const NetworkShape shape(sizes);
      const Numbers weights = make_random_weights(shape, 4);
      // One sample, less than a block, a block and one, more than a chunk.
      const bool large = shape.weight_count > 500;
      for (const std::size_t count :
           large ? std::vector<std::size_t>{65} : std::vector<std::size_t>{1, 63, 64, 577}) {
        MemorySource source = make_random_rows(shape, count, 6);
        NetworkProblem problem(shape, source, {}, kernel);
        const Gram gram = calc_gram(problem, weights);
        const Gram truth = calc_explicit(shape, weights, Rows(source));
        INFO(kernel.isa << " layers " << sizes.size() - 1 << " rows " << count);
        // Rounding of sums of `count` terms, below 1e-13, with a margin of ten.
        CHECK(calc_max_difference(gram.h, truth.h) <= tolerance(1e-12) * calc_max(truth.h));
        CHECK(calc_max_difference(gram.gradient, truth.gradient) <=
              tolerance(1e-12) * calc_max(truth.gradient));
        CHECK(std::fabs(gram.loss - truth.loss) <= tolerance(1e-12) * truth.loss);
        CHECK(problem.calc_loss(weights.data()) == gram.loss);
      }
    }
  }
}

TEST_CASE("The gradient agrees with differences of the loss", "[unit]") {
  const NetworkShape shape({3, 9, 5, 2});
  const Numbers weights = make_random_weights(shape, 8);
  MemorySource source = make_random_rows(shape, 100, 9);
  NetworkProblem problem(shape, source);
  const Gram gram = calc_gram(problem, weights);
  constexpr double kStep = 1e-5;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    Numbers up = weights, down = weights;
    up[i] += kStep;
    down[i] -= kStep;
    const double slope =
        (problem.calc_loss(up.data()) - problem.calc_loss(down.data())) / (4.0 * kStep);
    // d(e'e)/dw = 2 J'e; 1e-10 relative of curvature and rounding each.
    CHECK(std::fabs(slope - gram.gradient[i]) <= tolerance(1e-8) * calc_max(gram.gradient));
  }
}

TEST_CASE("The second derivative along a direction agrees with differences", "[unit]") {
  for (const TrainKernel& kernel : list_train_kernels()) {
    for (const auto& sizes : kShapes) {
      const NetworkShape shape(sizes);
      const Numbers weights = make_random_weights(shape, 10);
      const Numbers direction = make_random_weights(shape, 11);
      MemorySource source = make_random_rows(shape, 70, 12);
      NetworkProblem problem(shape, source, {}, kernel);
      Numbers gradient(weights.size()), truth(weights.size(), 0.0);
      problem.calc_second_gradient(weights.data(), direction.data(), gradient.data());
      const Rows rows(source);
      constexpr double kStep = 1e-4;
      Numbers up = weights, down = weights;
      for (std::size_t i = 0; i < weights.size(); ++i) {
        up[i] += kStep * direction[i];
        down[i] -= kStep * direction[i];
      }
      for (std::size_t row = 0; row < rows.count; ++row) {
        const double* x = rows.x.data() + row * static_cast<std::size_t>(shape.inputs());
        const auto j = test::calc_jacobian(shape, weights, x);
        const Numbers y = calc_outputs(shape, weights, x), y_up = calc_outputs(shape, up, x),
                      y_down = calc_outputs(shape, down, x);
        for (std::size_t k = 0; k < y.size(); ++k) {
          const double second = (y_up[k] - 2.0 * y[k] + y_down[k]) / (kStep * kStep);
          for (std::size_t i = 0; i < truth.size(); ++i) truth[i] += j[k][i] * second;
        }
      }
      INFO(kernel.isa << " layers " << sizes.size() - 1);
      // eps / h^2 = 2e-8 of rounding and h^2 = 1e-8 of curvature, with a factor of about fifty for
      // the fourth derivatives of wide layers.
      CHECK(calc_max_difference(gradient, truth) <=
            tolerance(2e-6) * std::max(1.0, calc_max(truth)));
    }
  }
}

/// Reads its rows in pieces of a given size, as from shards.
class PiecedSource : public RowSource {
 public:
  PiecedSource(RowSource& source, std::size_t piece) : source_(&source), piece_(piece) {}
  int input_count() const override { return source_->input_count(); }
  int target_count() const override { return source_->target_count(); }
  std::size_t row_count() const override { return source_->row_count(); }
  void read(std::size_t first, std::size_t count, double* inputs, double* targets) override {
    while (count > 0) {
      const std::size_t part = std::min(count, piece_ - first % piece_);
      source_->read(first, part, inputs, targets);
      first += part;
      count -= part;
      inputs += part * static_cast<std::size_t>(input_count());
      targets += part * static_cast<std::size_t>(target_count());
    }
  }

 private:
  RowSource* source_;
  std::size_t piece_;
};

TEST_CASE("Threads, batches and pieces do not change a bit of the sums",
          "[unit][property][threads]") {
  const NetworkShape shape({4, 27, 19, 11, 4});
  const Numbers weights = make_random_weights(shape, 13), v = make_random_weights(shape, 14);
  MemorySource source = make_random_rows(shape, 1400, 15);
  for (const TrainKernel& kernel : list_train_kernels()) {
    NetworkProblem reference(shape, source, {}, kernel);
    const Gram truth = calc_gram(reference, weights);
    Numbers second(weights.size()), other(weights.size());
    reference.calc_second_gradient(weights.data(), v.data(), second.data());
    for (const int threads : {1, 2, 3}) {
      for (const std::size_t batch : {1, 600, 5000}) {
        PiecedSource pieces(source, 10 + batch / 7);
        NetworkProblemOptions options;
        options.threads = threads;
        options.batch_rows = batch;
        NetworkProblem problem(shape, pieces, options, kernel);
        INFO(kernel.isa << " threads " << threads << " batch " << batch);
        CHECK((calc_gram(problem, weights) == truth));
        CHECK(problem.calc_loss(weights.data()) == truth.loss);
        problem.calc_second_gradient(weights.data(), v.data(), other.data());
        CHECK(other == second);
      }
    }
  }
}

TEST_CASE("Instruction sets agree", "[unit]") {
  const NetworkShape shape({4, 27, 19, 11, 4});
  const Numbers weights = make_random_weights(shape, 16);
  MemorySource source = make_random_rows(shape, 300, 17);
  NetworkProblem baseline(shape, source, {}, list_train_kernels().back());
  const Gram truth = calc_gram(baseline, weights);
  for (const TrainKernel& kernel : list_train_kernels()) {
    NetworkProblem problem(shape, source, {}, kernel);
    const Gram gram = calc_gram(problem, weights);
    INFO(kernel.isa);
    CHECK(calc_max_difference(gram.h, truth.h) <= tolerance(1e-12) * calc_max(truth.h));
  }
}

TEST_CASE("A sampled H is that of a window, scaled, and the gradient is that of all rows",
          "[unit]") {
  const NetworkShape shape({2, 5, 3});
  const Numbers weights = make_random_weights(shape, 18);
  MemorySource source = make_random_rows(shape, 250, 19);
  NetworkProblem full(shape, source);
  const Gram all = calc_gram(full, weights);
  NetworkProblemOptions options;
  options.gram_rows = 100;
  NetworkProblem sampled(shape, source, options);
  const Rows rows(source);
  for (const int epoch : {0, 1, 2}) {
    const std::size_t first = epoch == 1 ? 100 : 0;  // two windows, alternating
    MemorySource window(2,
                        Numbers(rows.x.begin() + 2 * static_cast<std::ptrdiff_t>(first),
                                rows.x.begin() + 2 * static_cast<std::ptrdiff_t>(first + 100)),
                        3, Numbers(300));
    NetworkProblem part(shape, window);
    Gram truth = calc_gram(part, weights);
    for (double& h : truth.h) h *= 2.5;
    const Gram gram = calc_gram(sampled, weights, epoch);
    CHECK(calc_max_difference(gram.h, truth.h) <= tolerance(1e-14) * calc_max(truth.h));
    CHECK(gram.gradient == all.gradient);
    CHECK(gram.loss == all.loss);
  }
}

TEST_CASE("A problem refuses data that do not fit its shape", "[unit]") {
  const NetworkShape shape({2, 5, 3});
  MemorySource source = make_random_rows(NetworkShape({3, 3}), 10, 1);
  CHECK_THROWS_AS(NetworkProblem(shape, source), InputError);
  CHECK_THROWS_AS(MemorySource(2, {1.0, 2.0, 3.0}, 1, {1.0}), InputError);
  CHECK_THROWS_AS(MemorySource(2, {1.0, 2.0}, 1, {1.0, 2.0}), InputError);
  CHECK_THROWS_AS(MemorySource(1, {1.0, std::nan("")}, 1, {1.0, 2.0}), InputError);
  NetworkProblemOptions options;
  options.threads = 0;
  CHECK_THROWS_AS(options.validate(), InputError);
}

/// H = A A' + I, lower triangle by columns.
Numbers make_positive_definite(std::size_t n) {
  const Numbers a = test::make_uniform(n * n, 20);
  Numbers h(n * n, 0.0);
  for (std::size_t c = 0; c < n; ++c) {
    for (std::size_t r = c; r < n; ++r) {
      for (std::size_t k = 0; k < n; ++k) h[c * n + r] += a[r * n + k] * a[c * n + k];
    }
    h[c * n + c] += 1.0;
  }
  return h;
}

TEST_CASE("Normal matrices and products with lower triangles are sums on any instruction set",
          "[unit]") {
  const std::size_t rows = 37, n = 19;
  const Numbers a = test::make_uniform(rows * n, 22), l = test::make_uniform(n * n, 23);
  for (const CholeskyKernel& kernel : list_cholesky_kernels()) {
    CAPTURE(kernel.isa);
    Numbers h(n * n, 1.0), b(rows * n, 0.0);
    kernel.add_normal(a.data(), rows, n, h.data());
    kernel.multiply_lower(a.data(), l.data(), rows, n, b.data());
    for (std::size_t c = 0; c < n; ++c) {
      for (std::size_t r = 0; r < n; ++r) {
        double sum = 1.0;  // above the diagonal, as before
        for (std::size_t k = 0; r >= c && k < rows; ++k) sum += a[r * rows + k] * a[c * rows + k];
        CHECK(std::fabs(h[c * n + r] - sum) < tolerance(1e-13));
      }
      for (std::size_t r = 0; r < rows; ++r) {
        double sum = 0.0;
        for (std::size_t k = c; k < n; ++k) sum += a[k * rows + r] * l[c * n + k];
        CHECK(std::fabs(b[c * rows + r] - sum) < tolerance(1e-13));
      }
    }
  }
}

TEST_CASE("A damped system is solved, with the same bits on any number of threads",
          "[unit][threads]") {
  for (const std::size_t n : {1, 95, 96, 97, 250}) {
    const Numbers h = make_positive_definite(n), b = test::make_uniform(n, 21);
    const Numbers scale(n, 2.0);
    for (const CholeskyKernel& kernel : list_cholesky_kernels()) {
      Numbers first;
      for (const int threads : {1, 2, 3}) {
        DampedSystem system(n, threads, kernel);
        REQUIRE(system.factor(h, scale, 0.5));
        Numbers x = b;
        system.solve(x);
        if (threads == 1) first = x;
        CHECK(x == first);
        for (std::size_t r = 0; r < n; ++r) {
          double sum = x[r];  // damping * scale
          for (std::size_t c = 0; c < n; ++c) sum += h[std::min(r, c) * n + std::max(r, c)] * x[c];
          // eps times the norm of H, which is about n.
          CHECK(std::fabs(sum - b[r]) <= tolerance(1e-14) * static_cast<double>(n));
        }
      }
      Numbers indefinite = h;
      indefinite[n * n - 1] = -1e6;
      CHECK_FALSE(DampedSystem(n, 1, kernel).factor(indefinite, scale, 0.5));
      indefinite[n * n - 1] = std::nan("");
      CHECK_FALSE(DampedSystem(n, 1, kernel).factor(indefinite, scale, 0.5));
    }
  }
}

}  // namespace
}  // namespace strut
