// The fit of an effect to readings that are linear in it, against the linear system solved
// directly.
#include "diagnose/hypothesis/hypothesis_search.h"

#include <Eigen/Dense>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/campaign_files.h"
#include "tests/support/linear_model.h"
#include "tests/support/tolerance.h"
#include "tests/support/unit_noise.h"

namespace strut {
namespace {

using test::make_plain_unknown;
using test::tolerance;

constexpr Eigen::Index kReadings = 60;
constexpr double kStart = 0.2, kShapeStart = -3.0;

Eigen::VectorXd draw(std::uint64_t stream) {
  Eigen::VectorXd values(kReadings);
  for (Eigen::Index i = 0; i < kReadings; ++i) {
    values(i) = test::calc_test_normal(31, stream, static_cast<std::uint64_t>(i));
  }
  return values;
}

/// Keeps the values at which it was evaluated.
class ObservedModel : public test::LinearModel {
 public:
  using LinearModel::LinearModel;
  std::vector<Evaluation> evaluate(const std::vector<std::vector<double>>& points) override {
    seen.insert(seen.end(), points.begin(), points.end());
    return LinearModel::evaluate(points);
  }
  std::vector<std::vector<double>> seen;
};

/// One parameter of the model, and an effect with a size and a shape.
struct Problem {
  Eigen::MatrixXd matrix{kReadings, 3};
  Eigen::VectorXd offset;
  Hypothesis hypothesis;
  std::vector<Unknown> own = {make_plain_unknown("size"), make_plain_unknown("shape")};

  explicit Problem(double size = 8.0) {
    matrix << draw(1), 5.0 * draw(2), 0.3 * draw(3);
    offset = draw(4) - size * matrix.col(1);
    hypothesis.effect = "effect";
    hypothesis.parameters = {{"size", "size", true}, {"shape", "shape", false}};
    hypothesis.reference = {0.0, 0.0};
  }

  /// Readings with the effect off, its shape at its start.
  Eigen::VectorXd calc_offset_of_base() const { return offset + kShapeStart * matrix.col(2); }

  /// Rows of all readings, and of the prior of the shape: sigma 1 about its start.
  Eigen::MatrixXd make_rows() const {
    Eigen::MatrixXd rows(kReadings + 1, 3);
    rows << matrix, 0.0, 0.0, 1.0;
    return rows;
  }
  Eigen::VectorXd make_right_side() const {
    Eigen::VectorXd right(kReadings + 1);
    right << -offset, kShapeStart;
    return right;
  }

  /// `roads`: not empty where the search moves the effect alone.
  HypothesisFit fit(bool has_inputs = true, const LatentRoads& roads = {}) const {
    const Unknown parameter = make_plain_unknown("parameter", 2.0);
    const Eigen::VectorXd column = matrix.col(0), base = calc_offset_of_base();
    const double best = -column.dot(base) / column.squaredNorm();
    test::LinearModel base_model({parameter}, column, base);
    const Whitener whitener(base_model, {test::make_unit_noise(kReadings)}, roads);
    const Linearization at = whitener.apply(base_model.linearize({best}));
    const Eigen::MatrixXd normal = at.jacobian.transpose() * at.jacobian;
    const Eigen::LDLT<Eigen::MatrixXd> regular(normal);
    const std::vector<Unknown> unknowns = {parameter};
    const std::vector<double> values = {best};
    const SearchGround ground{has_inputs,  unknowns,    values, whitener,
                              at.residual, at.jacobian, normal, regular};
    ObservedModel model({parameter, own[0], own[1]}, matrix, offset);
    HypothesisFit fit = search_hypothesis(ground, model, hypothesis, own, {kStart, kShapeStart});
    for (const std::vector<double>& point : model.seen) {
      largest_move = std::max(largest_move, std::abs(point.front() - best) * column.norm());
    }
    return fit;
  }
  mutable double largest_move = 0.0;  // of the parameter in simulations, in standard deviations
};

TEST_CASE("The fit of an effect is that of the linear system with the shape's prior", "[unit]") {
  const Problem problem;
  const auto [has_inputs, roads] =
      GENERATE(std::pair{true, LatentRoads{}}, std::pair{false, LatentRoads{}},
               std::pair{false, LatentRoads{nullptr}});
  const HypothesisFit fit = problem.fit(has_inputs, roads);
  REQUIRE(fit.failure.empty());
  CHECK(fit.converged);
  const Eigen::MatrixXd rows = problem.make_rows();
  const Eigen::VectorXd right = problem.make_right_side();
  const Eigen::VectorXd solution = rows.colPivHouseholderQr().solve(right);
  const Eigen::MatrixXd covariance = (rows.transpose() * rows).inverse();
  for (Eigen::Index i = 0; i < 3; ++i) {
    // Within the tolerance of a converged fit, a tenth of a standard error.
    CHECK(std::abs(fit.values[static_cast<std::size_t>(i)] - solution(i)) <
          tolerance(0.1) * std::sqrt(covariance(i, i)));
  }
  REQUIRE(fit.sigma.size() == 2);
  CHECK(fit.sigma[0] == Approx(std::sqrt(covariance(1, 1))).epsilon(tolerance(1e-6)));
  CHECK(fit.sigma[1] == Approx(std::sqrt(covariance(2, 2))).epsilon(tolerance(1e-6)));
  const Eigen::VectorXd column = problem.matrix.col(0), base = problem.calc_offset_of_base();
  const double without =
      base.squaredNorm() - std::pow(column.dot(base), 2.0) / column.squaredNorm();
  // chi2 is 0.01 above its minimum at a tenth of a standard error.
  CHECK(fit.gain ==
        Approx(without - (rows * solution - right).squaredNorm()).margin(tolerance(0.02)));
}

TEST_CASE("Over a road that was found simulations move other unknowns only where they follow far",
          "[unit]") {
  const Problem small(0.1), large(8.0);
  small.fit(false, LatentRoads{nullptr});
  CHECK(small.largest_move == 0.0);
  large.fit(false, LatentRoads{nullptr});
  CHECK(large.largest_move > 3.0);
  // Elsewhere they always move.
  small.fit(false);
  CHECK(small.largest_move > 0.0);
}

}  // namespace
}  // namespace strut
