#include "diagnose/hypothesis/evidence.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace strut {

Score calc_score(const Evidence& evidence, const std::vector<double>& weights) {
  Eigen::MatrixXd sum = evidence.products.back();
  Score score;
  score.norm = Eigen::VectorXd::Zero(evidence.norms.front().size());
  for (std::size_t r = 0; r < evidence.run_count(); ++r) {
    sum += weights[r] * evidence.products[r];
    score.norm += weights[r] * evidence.norms[r];
  }
  const auto shared = static_cast<Eigen::Index>(evidence.shared);
  const Eigen::Index count = sum.rows() - shared - 1;
  if (shared > 0) {
    Eigen::MatrixXd own = sum.topLeftCorner(shared, shared);
    own.diagonal() *= 1.0 + 1e-12;
    const Eigen::MatrixXd mixed = sum.topRightCorner(shared, count + 1);
    const Eigen::MatrixXd solved = own.ldlt().solve(mixed);
    sum.bottomRightCorner(count + 1, count + 1) -= mixed.transpose() * solved;
    score.correction = -solved.leftCols(count);
  }
  score.covariance = sum.block(shared, shared, count, count);
  score.gradient = -sum.block(shared, shared + count, count, 1);
  score.chi2 = sum(sum.rows() - 1, sum.cols() - 1);
  return score;
}

bool is_seen(const Score& score, Eigen::Index column) {
  constexpr double kAlias = 1e-4, kUnseen = 1e-6;
  // A hypothesis that the free unknowns can take over but for a hundredth is none of its own, and
  // one that moves nothing (a roll bar where both wheels do the same) is rounding.
  return score.covariance(column, column) > std::max(kAlias * score.norm(column), kUnseen);
}

Gain calc_gain(const Score& score, const std::vector<std::size_t>& columns, bool one_sided) {
  constexpr double kRank = 1e-8;
  const auto count = static_cast<Eigen::Index>(columns.size());
  Eigen::MatrixXd k(count, count);
  Eigen::VectorXd z(count), scale(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto at = static_cast<Eigen::Index>(columns[static_cast<std::size_t>(i)]);
    scale(i) = is_seen(score, at) ? 1.0 / std::sqrt(score.covariance(at, at)) : 0.0;
    z(i) = score.gradient(at) * scale(i);
  }
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index j = 0; j < count; ++j) {
      k(i, j) = score.covariance(static_cast<Eigen::Index>(columns[static_cast<std::size_t>(i)]),
                                 static_cast<Eigen::Index>(columns[static_cast<std::size_t>(j)])) *
                scale(i) * scale(j);
    }
  }
  Gain gain{0.0, Eigen::VectorXd::Zero(count)};
  if (one_sided && count == 1 && z(0) <= 0.0) return gain;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(k);
  for (Eigen::Index i = 0; i < count; ++i) {
    const double value = solver.eigenvalues()(i);
    if (value < kRank * static_cast<double>(count)) continue;
    const double part = solver.eigenvectors().col(i).dot(z);
    gain.chi2 += part * part / value;
    gain.amplitude += part / value * solver.eigenvectors().col(i).cwiseProduct(scale);
  }
  return gain;
}

}  // namespace strut
