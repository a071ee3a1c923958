#include "sweep/fisher.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

namespace strut {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

using Solver = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>;

/// 1 / sqrt(diagonal), zero where a parameter has no information at all.
Eigen::VectorXd calc_scales(const Eigen::MatrixXd& information) {
  return information.diagonal().unaryExpr(
      [](double d) { return d > 0.0 ? 1.0 / std::sqrt(d) : 0.0; });
}

/// Variances and rank from F scaled to a unit diagonal, D F D = V diag(l) V': diag(F^-1)_i = D_i^2
/// sum_k V_ik^2 / l_k. A parameter that takes part in an unresolved direction is free.
void calc_variances(const Eigen::MatrixXd& information, Bounds& bounds) {
  const Eigen::VectorXd scale = calc_scales(information);
  const Solver solver(scale.asDiagonal() * information * scale.asDiagonal());
  const Eigen::Index n = information.rows();
  const double least = kLeastInformation * solver.eigenvalues()(n - 1);
  constexpr double kPart = 1e-6;  // share of a free direction above rounding
  Eigen::VectorXd variance = Eigen::VectorXd::Zero(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const double value = solver.eigenvalues()(k);
    const bool resolved = value > least;
    bounds.rank += resolved ? 1 : 0;
    for (Eigen::Index i = 0; i < n; ++i) {
      const double part = solver.eigenvectors()(i, k);
      if (resolved) variance(i) += scale(i) * scale(i) * part * part / value;
      if (!resolved && std::abs(part) > kPart) variance(i) = kInfinity;
    }
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    bounds.bound.push_back(scale(i) > 0.0 ? std::sqrt(variance(i)) : kInfinity);
  }
}

}  // namespace

Bounds calc_bounds(const Eigen::MatrixXd& information) {
  Bounds bounds;
  const Eigen::Index n = information.rows();
  bounds.bound.reserve(static_cast<std::size_t>(n));
  calc_variances(information, bounds);
  double sum = 0.0;
  for (const double b : bounds.bound) sum += b * b;
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
  constexpr double kRounding = 1e-13;  // of F, so that it stays positive definite
  const Eigen::Index n = information.rows();
  inverse_ = information;
  inverse_.diagonal().array() += kPrior + kRounding * information.trace();
  factor_.compute(inverse_);
  inverse_.setIdentity();
  factor_.matrixL().solveInPlace(inverse_);
  return std::sqrt(inverse_.squaredNorm() / static_cast<double>(n));
}

}  // namespace strut
