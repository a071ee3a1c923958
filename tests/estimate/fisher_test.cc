// Fisher information and Cramer-Rao bounds on models with answers in closed form.

#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "estimate/instants.h"
#include "tests/support/test_car.h"

namespace strut {
namespace {

using Eigen::MatrixXd;
using test::Random;
using test::tolerance;

constexpr double kPi = std::numbers::pi;

/// Sensitivity of one channel, body_position_z, with rows of derivatives by parameters of 100 %
/// = `scale`.
Sensitivity make_toy(const MatrixXd& rows, const std::vector<double>& scale) {
  Sensitivity s;
  for (std::size_t p = 0; p < scale.size(); ++p) {
    s.parameters.push_back({"p" + std::to_string(p), "1", scale[p], scale[p], 1e-4 * scale[p]});
  }
  const std::size_t count = scale.size();
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    Instant instant;
    instant.jacobian.assign(CarChannel::kCount * count, 0.0);
    for (std::size_t p = 0; p < count; ++p) {
      instant.jacobian[CarChannel::kBodyPositionZ * count + p] =
          rows(i, static_cast<Eigen::Index>(p));
    }
    s.instants.push_back(std::move(instant));
  }
  return s;
}

MatrixXd calc_total(const Sensitivity& s, double sigma) {
  SensorNoise noise(CarChannel::kCount, 0.0);
  noise[CarChannel::kBodyPositionZ] = sigma;
  return sum_informations(calc_informations(s, {CarChannel::kBodyPositionZ}, noise));
}

MatrixXd make_random_rows(Random& random, Eigen::Index rows, Eigen::Index columns) {
  MatrixXd m(rows, columns);
  for (double& value : m.reshaped()) value = random.uniform(-1.0, 1.0);
  return m;
}

double make_normal(Random& random) {
  const double radius = std::sqrt(-2.0 * std::log(random.uniform(1e-12, 1.0)));
  return radius * std::cos(2.0 * kPi * random.uniform(0.0, 1.0));
}

TEST_CASE("Amplitudes of an oscillation are known to sigma sqrt(2 / N)", "[unit]") {
  // y = a cos(w t) + b sin(w t) over whole periods.
  constexpr Eigen::Index kSamples = 120;
  MatrixXd rows(kSamples, 2);
  for (Eigen::Index i = 0; i < kSamples; ++i) {
    const double phase = 2.0 * kPi * 3.0 * static_cast<double>(i) / kSamples;
    rows.row(i) << std::cos(phase), std::sin(phase);
  }
  const double a = 2.0, b = -0.5, sigma = 0.1;
  const Bounds bounds = calc_bounds(calc_total(make_toy(rows, {a, std::abs(b)}), sigma));
  const double absolute = sigma * std::sqrt(2.0 / kSamples);
  CHECK(bounds.bound[0] == Approx(100.0 * absolute / a).epsilon(tolerance(1e-12)));
  CHECK(bounds.bound[1] == Approx(100.0 * absolute / -b).epsilon(tolerance(1e-12)));
  CHECK(bounds.condition == Approx(a * a / (b * b)).epsilon(tolerance(1e-12)));
  CHECK(bounds.rank == 2);
}

TEST_CASE("A correlation rho widens the bound by 1 / sqrt(1 - rho^2)", "[unit]") {
  const double rho = GENERATE(0.0, 0.6, 0.999, 1.0 - 1e-8);
  MatrixXd information(2, 2);
  information << 4.0, 2.0 * rho, 2.0 * rho, 1.0;
  const Bounds bounds = calc_bounds(information);
  const double widening = 1.0 / std::sqrt(1.0 - rho * rho);
  // Rounding of 1 - rho^2.
  CHECK(bounds.bound[0] == Approx(0.5 * widening).epsilon(tolerance(1e-7)));
  CHECK(bounds.bound[1] == Approx(widening).epsilon(tolerance(1e-7)));
}

TEST_CASE("Bounds do not depend on the scale of the parameters", "[property]") {
  Random random(1);
  const MatrixXd rows = make_random_rows(random, 9, 4);
  const Bounds one = calc_bounds(calc_total(make_toy(rows, {1.0, 1.0, 1.0, 1.0}), 0.1));
  const std::vector<double> scale{1e4, 3e-3, 7.0, 1e-6};
  const Bounds other = calc_bounds(calc_total(make_toy(rows, scale), 0.1));
  for (std::size_t p = 0; p < scale.size(); ++p) {
    CHECK(other.bound[p] * scale[p] == Approx(one.bound[p]).epsilon(tolerance(1e-9)));
  }
  CHECK(other.rank == 4);
}

TEST_CASE("A parameter without effect is not identifiable, the others are", "[unit]") {
  Random random(2);
  MatrixXd rows = make_random_rows(random, 9, 3);
  const Bounds alone = calc_bounds(calc_total(make_toy(rows.leftCols(2), {1.0, 1.0}), 0.1));
  rows.col(2).setZero();
  const Bounds bounds = calc_bounds(calc_total(make_toy(rows, {1.0, 1.0, 1.0}), 0.1));
  CHECK(bounds.rank == 2);
  CHECK(std::isinf(bounds.condition));
  CHECK(std::isinf(bounds.weakest_bound));
  CHECK(std::abs(bounds.weakest[2]) == Approx(1.0));
  CHECK(std::isinf(bounds.bound[2]));
  for (const std::size_t p : {0, 1}) {
    CHECK(bounds.bound[p] == Approx(alone.bound[p]).epsilon(tolerance(1e-12)));
  }
}

TEST_CASE("Of parameters that act alike only the sum is identifiable", "[unit]") {
  Random random(3);
  MatrixXd rows = make_random_rows(random, 9, 3);
  rows.col(1) = rows.col(0);
  const Bounds bounds = calc_bounds(calc_total(make_toy(rows, {1.0, 1.0, 1.0}), 0.1));
  CHECK(bounds.rank == 2);
  CHECK(std::isinf(bounds.bound[0]));
  CHECK(std::isinf(bounds.bound[1]));
  CHECK(std::isfinite(bounds.bound[2]));
  CHECK(bounds.weakest[0] == Approx(-bounds.weakest[1]));
  CHECK(std::abs(bounds.weakest[0]) == Approx(std::sqrt(0.5)));
}

TEST_CASE("Without information no parameter is identifiable", "[unit]") {
  const Bounds bounds = calc_bounds(MatrixXd::Zero(3, 3));
  CHECK(bounds.rank == 0);
  for (const double b : bounds.bound) CHECK(std::isinf(b));
}

TEST_CASE("More measurements never worsen a bound", "[property]") {
  Random random(4);
  MatrixXd information = MatrixXd::Zero(4, 4);
  std::vector<double> before(4, std::numeric_limits<double>::infinity());
  for (int i = 0; i < 200; ++i) {
    const MatrixXd row = make_random_rows(random, 1, 4);
    information += row.transpose() * row;
    const Bounds bounds = calc_bounds(information);
    for (std::size_t p = 0; p < 4; ++p) {
      REQUIRE(bounds.bound[p] <= before[p] * (1.0 + 1e-9));
      before[p] = bounds.bound[p];
    }
  }
}

TEST_CASE("Least squares estimates spread as the bound says", "[statistical]") {
  constexpr int kTrials = 4000;
  const double sigma = 0.3;
  Random random(5);
  const MatrixXd rows = make_random_rows(random, 12, 3);
  const Bounds bounds = calc_bounds(calc_total(make_toy(rows, {1.0, 1.0, 1.0}), sigma));
  const Eigen::ColPivHouseholderQR<MatrixXd> solver(rows);
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  for (int trial = 0; trial < kTrials; ++trial) {
    Eigen::VectorXd noise(rows.rows());
    for (double& value : noise) value = sigma * make_normal(random);
    squares += Eigen::Vector3d(solver.solve(noise)).cwiseAbs2();
  }
  for (std::size_t p = 0; p < 3; ++p) {
    const double spread = 100.0 * std::sqrt(squares(static_cast<Eigen::Index>(p)) / kTrials);
    // The standard deviation of a standard deviation is 1 / sqrt(2 trials) = 1.1 %: four of them.
    CHECK(spread == Approx(bounds.bound[p]).epsilon(tolerance(0.045)));
  }
}

TEST_CASE("The criterion of the search is the rms of the bounds", "[unit]") {
  Random random(6);
  for (const int n : {1, 2, 4, 7}) {
    const MatrixXd rows = make_random_rows(random, n + 3, n);
    const MatrixXd information = rows.transpose() * rows;
    SpreadCriterion criterion(n);
    // The prior of 1e4 % costs 1e-8 per bound of 1 %.
    CHECK(criterion.calc(information) ==
          Approx(calc_bounds(information).rms).epsilon(tolerance(1e-4)));
  }
  SpreadCriterion criterion(2);
  MatrixXd one = MatrixXd::Zero(2, 2);
  one(0, 0) = 1.0;
  CHECK(criterion.calc(one) < criterion.calc(MatrixXd::Zero(2, 2)));
}

TEST_CASE("Exchange finds the best pair and triple of instants", "[property]") {
  Random random(7);
  std::vector<MatrixXd> informations;
  for (int i = 0; i < 30; ++i) {
    const MatrixXd row = make_random_rows(random, 1, 3);  // three are needed for three parameters
    informations.push_back(row.transpose() * row);
  }
  SpreadCriterion criterion(3);
  double pair = std::numeric_limits<double>::infinity(), triple = pair;
  for (std::size_t i = 0; i < informations.size(); ++i) {
    for (std::size_t j = i + 1; j < informations.size(); ++j) {
      const MatrixXd two = informations[i] + informations[j];
      pair = std::min(pair, criterion.calc(two));
      for (std::size_t k = j + 1; k < informations.size(); ++k) {
        triple = std::min(triple, criterion.calc(two + informations[k]));
      }
    }
  }
  const InstantChoice best2 = choose_instants(informations, 2);
  const InstantChoice best3 = choose_instants(informations, 3);
  CHECK(criterion.calc(best2.information) == Approx(pair).epsilon(1e-12));
  CHECK(criterion.calc(best3.information) == Approx(triple).epsilon(1e-12));
  CHECK(best3.instants[0] < best3.instants[1]);
  CHECK(best3.instants[1] < best3.instants[2]);
}

}  // namespace
}  // namespace strut
