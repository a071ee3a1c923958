#include "estimate/fisher.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

namespace strut {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

using Solver = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>;

/// 1 / sqrt(diagonal); 0 where a parameter has no information.
Eigen::VectorXd calc_scales(const Eigen::MatrixXd& information) {
  return information.diagonal().unaryExpr(
      [](double d) { return d > 0.0 ? 1.0 / std::sqrt(d) : 0.0; });
}

}  // namespace

InformationInverse invert_information(const Eigen::MatrixXd& information) {
  constexpr double kMinPart = 1e-6;  // min component of a free direction, above rounding error
  const Eigen::Index n = information.rows();
  const Eigen::VectorXd scale = calc_scales(information);
  const Solver solver(scale.asDiagonal() * information * scale.asDiagonal());
  const double min_eigenvalue = kMinInformation * solver.eigenvalues()(n - 1);
  Eigen::VectorXd inverse = Eigen::VectorXd::Zero(n);
  InformationInverse result;
  result.free.resize(static_cast<std::size_t>(n));
  for (Eigen::Index i = 0; i < n; ++i) result.free[static_cast<std::size_t>(i)] = !(scale(i) > 0.0);
  for (Eigen::Index k = 0; k < n; ++k) {
    if (solver.eigenvalues()(k) > min_eigenvalue) {
      ++result.rank;
      inverse(k) = 1.0 / solver.eigenvalues()(k);
      continue;
    }
    for (Eigen::Index i = 0; i < n; ++i) {
      if (std::abs(solver.eigenvectors()(i, k)) > kMinPart) {
        result.free[static_cast<std::size_t>(i)] = true;
      }
    }
  }
  const Eigen::MatrixXd scaled = scale.asDiagonal() * solver.eigenvectors();
  result.covariance = scaled * inverse.asDiagonal() * scaled.transpose();
  return result;
}

Bounds calc_bounds(const Eigen::MatrixXd& information) {
  Bounds bounds;
  const Eigen::Index n = information.rows();
  const InformationInverse inverse = invert_information(information);
  bounds.rank = inverse.rank;
  bounds.bound.reserve(static_cast<std::size_t>(n));
  double sum = 0.0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const bool free = inverse.free[static_cast<std::size_t>(i)];
    const double b = free ? kInfinity : std::sqrt(inverse.covariance(i, i));
    bounds.bound.push_back(b);
    sum += b * b;
  }
  bounds.rms = std::sqrt(sum / static_cast<double>(n));

  const Solver solver(information);
  const Eigen::VectorXd weakest = solver.eigenvectors().col(0);
  bounds.weakest.assign(weakest.data(), weakest.data() + n);
  const bool regular = bounds.rank == n && solver.eigenvalues()(0) > 0.0;
  const double smallest = solver.eigenvalues()(0);
  bounds.condition = regular ? solver.eigenvalues()(n - 1) / smallest : kInfinity;
  bounds.weakest_bound = regular ? 1.0 / std::sqrt(smallest) : kInfinity;
  return bounds;
}

SpreadCriterion::SpreadCriterion(Eigen::Index size) : factor_(size), inverse_(size, size) {}

double SpreadCriterion::calc(const Eigen::MatrixXd& information) {
  constexpr double kPrior = 1e-8;      // 1/%^2
  constexpr double kRounding = 1e-13;  // fraction of F's trace; keeps F positive definite
  const Eigen::Index n = information.rows();
  inverse_ = information;
  inverse_.diagonal().array() += kPrior + kRounding * information.trace();
  factor_.compute(inverse_);
  inverse_.setIdentity();
  factor_.matrixL().solveInPlace(inverse_);
  return std::sqrt(inverse_.squaredNorm() / static_cast<double>(n));
}

}  // namespace strut
