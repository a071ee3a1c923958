#include "diagnose/discrepancy/map_prior.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

namespace strut {
namespace {

using Index = Eigen::Index;

Eigen::VectorXd calc_weights(const std::vector<MapShape>& shapes,
                             const std::array<double, kMapShares>& size) {
  Eigen::VectorXd weights(static_cast<Index>(shapes.size()));
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    weights(static_cast<Index>(i)) =
        size[static_cast<std::size_t>(shapes[i].share)] / std::sqrt(shapes[i].roughness);
  }
  return weights;
}

/// ln L less that of no map; -infinity where rounding hides it.
double calc_log_likelihood(const MapEvidence& e, const Eigen::VectorXd& weights) {
  const Index n = weights.size();
  Eigen::MatrixXd inner = weights.asDiagonal() * e.information * weights.asDiagonal();
  inner.diagonal().array() += 1.0;
  const Eigen::LLT<Eigen::MatrixXd> factor(inner);
  if (factor.info() != Eigen::Success) return -std::numeric_limits<double>::infinity();
  const Eigen::VectorXd weighted = weights.cwiseProduct(e.gradient);
  const double taken = weighted.dot(factor.solve(weighted));
  double log_determinant = 0.0;
  for (Index i = 0; i < n; ++i) log_determinant += 2.0 * std::log(factor.matrixL()(i, i));
  return -0.5 * e.count * std::log1p(-std::min(taken / e.chi2, 1.0 - 1e-12)) -
         0.5 * log_determinant;
}

/// The size at which the shapes of a share would do to the readings what noise does.
double find_unit(const MapEvidence& e, const std::vector<MapShape>& shapes, MapShare share) {
  double most = 0.0;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const auto k = static_cast<Index>(i);
    if (shapes[i].share != share) continue;
    most = std::max(most, e.information(k, k) / shapes[i].roughness);
  }
  return most > 0.0 ? 1.0 / std::sqrt(most) : 0.0;
}

}  // namespace

Eigen::LDLT<Eigen::MatrixXd> factor_base(const Eigen::MatrixXd& jacobian) {
  Eigen::MatrixXd information = jacobian.transpose() * jacobian;
  // Unknowns of which the readings say nothing leave zeros.
  information.diagonal().array() *= 1.0 + 1e-12;
  information.diagonal().array() += 1e-12;
  return Eigen::LDLT<Eigen::MatrixXd>(information);
}

MapEvidence eliminate_base(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& jacobian,
                           const Eigen::VectorXd& residual) {
  const Eigen::LDLT<Eigen::MatrixXd> factor = factor_base(jacobian);
  const Eigen::MatrixXd mixed = jacobian.transpose() * columns;
  const Eigen::VectorXd slope = jacobian.transpose() * residual;
  MapEvidence e;
  e.information = columns.transpose() * columns - mixed.transpose() * factor.solve(mixed);
  e.gradient = columns.transpose() * residual - mixed.transpose() * factor.solve(slope);
  e.chi2 = residual.squaredNorm() - slope.dot(factor.solve(slope));
  e.count = static_cast<double>(residual.size() - jacobian.cols());
  return e;
}

MapPrior choose_map_prior(const MapEvidence& evidence, const std::vector<MapShape>& shapes) {
  MapPrior prior;
  prior.weights = calc_weights(shapes, prior.size);
  // Sizes from a third of what is seen at all to what dwarfs the noise, in steps that halve.
  constexpr double kSmallest = 0.3, kLargest = 1e6, kFirstStep = 8.0, kLastStep = 1.2;
  std::array<double, kMapShares> unit{};
  for (int s = 0; s < kMapShares; ++s) {
    unit[static_cast<std::size_t>(s)] = find_unit(evidence, shapes, static_cast<MapShare>(s));
  }
  const auto attempt = [&](std::size_t share, double size) {
    std::array<double, kMapShares> sizes = prior.size;
    sizes[share] = size;
    const Eigen::VectorXd weights = calc_weights(shapes, sizes);
    const double log_likelihood = calc_log_likelihood(evidence, weights);
    if (!(log_likelihood > prior.log_likelihood)) return;
    prior = {sizes, weights, log_likelihood};
  };
  for (double step = kFirstStep; step > kLastStep; step = std::sqrt(step)) {
    constexpr int kSweeps = 3;
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      for (std::size_t share = 0; share < prior.size.size(); ++share) {
        if (unit[share] == 0.0) continue;
        const double now = prior.size[share];
        attempt(share, 0.0);
        if (now > 0.0 && step < kFirstStep) {
          attempt(share, now * step);
          attempt(share, now / step);
          continue;
        }
        for (double size = kSmallest; size < kLargest; size *= kFirstStep) {
          attempt(share, size * unit[share]);
        }
      }
    }
  }
  return prior;
}

Eigen::VectorXd calc_map_mean(const MapEvidence& evidence, const MapPrior& prior) {
  const auto weights = prior.weights.asDiagonal();
  Eigen::MatrixXd inner = weights * evidence.information * weights;
  inner.diagonal().array() += 1.0;
  return -(weights * inner.ldlt().solve(weights * evidence.gradient));
}

Eigen::MatrixXd combine_shapes(const MapEvidence& evidence, const MapPrior& prior) {
  // Less than this share of the prior is known: nothing but the prior.
  constexpr double kTold = 0.05;
  constexpr Index kMost = 30;
  const Eigen::MatrixXd seen =
      prior.weights.asDiagonal() * evidence.information * prior.weights.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(seen);
  const Index n = seen.rows();
  Index kept = 0;
  while (kept < std::min(n, kMost) && solver.eigenvalues()(n - 1 - kept) > kTold) ++kept;
  return prior.weights.asDiagonal() * solver.eigenvectors().rightCols(kept).rowwise().reverse();
}

}  // namespace strut
