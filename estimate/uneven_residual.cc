#include "estimate/uneven_residual.h"

#include <algorithm>
#include <cmath>

namespace strut {

Eigen::VectorXd calc_growth(const ReadingModel& model, const Linearization& at,
                            const Eigen::MatrixXd& covariance, const Eigen::MatrixXd& of_priors,
                            double misfit) {
  constexpr double kMargin = 2.0;
  // Least 1 - h: below it the fit follows a reading, and its residual is what the search has left.
  constexpr double kMinRest = 1e-3;
  const Eigen::Index n = covariance.rows();
  Eigen::VectorXd growth = Eigen::VectorXd::Ones(n);
  if (!model.has_independent_residuals()) return growth;
  Eigen::ArrayXd sums = Eigen::ArrayXd::Zero(n), fourth = sums, expected = sums, found = sums;
  for (const RunBlock& block : list_blocks(model)) {
    const Eigen::MatrixXd jacobian = get_block(at.jacobian, block) / std::sqrt(misfit);
    const Eigen::ArrayXd squares =
        at.residual.segment(block.begin, block.count).array().square() / misfit;
    const Eigen::MatrixXd influence = jacobian * covariance(block.unknowns, Eigen::all);
    const Eigen::ArrayXd rest =
        1.0 - influence(Eigen::all, block.unknowns).cwiseProduct(jacobian).rowwise().sum().array();
    const Eigen::ArrayXd counts = (rest > kMinRest).cast<double>();
    const Eigen::ArrayXXd weights = influence.array().square().colwise() * counts;
    sums += weights.colwise().sum().transpose();
    fourth += weights.square().colwise().sum().transpose();
    expected += (weights.colwise() * rest).colwise().sum().transpose();
    found += (weights.colwise() * squares).colwise().sum().transpose();
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    const double variance = covariance(i, i);
    if (!(expected(i) > 0.0) || !(variance > 0.0)) continue;
    const double margin = kMargin * std::sqrt(2.0 * fourth(i)) / sums(i);
    const double excess = found(i) / expected(i) - 1.0 - margin;
    if (!(excess > 0.0)) continue;
    const double most = of_priors(i, i) > 0.0 ? 1.0 / (of_priors(i, i) * variance) : INFINITY;
    growth(i) = std::sqrt(std::clamp(1.0 + excess * sums(i) / variance, 1.0, std::max(1.0, most)));
  }
  return growth;
}

}  // namespace strut
