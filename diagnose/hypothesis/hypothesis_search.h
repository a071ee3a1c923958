// One hypothesis fitted beside all that a fit adjusts: Gauss-Newton, damped. Sizes are counted as
// multiples of their beginning, shapes by their logarithm where they are positive, as no shape is
// known but to a factor; all shapes are held by a prior of 1 about their beginning.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <string>
#include <vector>

#include "base/math/eigen_abi.h"
#include "diagnose/hypothesis/hypothesis.h"
#include "diagnose/noise/whitener.h"

namespace strut {

/// A fit of a hypothesis together with all that the model may adjust.
struct HypothesisFit {
  std::string failure;         // empty: it could be simulated
  std::vector<double> values;  // of the base unknowns, then of the hypothesis' parameters
  std::vector<double> sigma;   // of the hypothesis' parameters, everything else adjusted
  double gain = 0.0;           // by which chi2 fell
  long simulations = 0;
};

/// The fit that it starts from. All must outlive the search.
struct SearchGround {
  bool has_inputs = false;
  const std::vector<Unknown>& unknowns;
  const std::vector<double>& values;
  const Whitener& whitener;
  const Eigen::VectorXd& residual;  // whitened, then priors
  const Eigen::MatrixXd& jacobian;  // by unknowns in their scale
  const Eigen::MatrixXd& normal;    // its products
  const Eigen::LDLT<Eigen::MatrixXd>& regular_normal;
};

/// `model`: of the ground's unknowns, the hypothesis' `own` behind. Of a car the derivatives by the
/// ground's unknowns stay those of the ground, of a rig all are computed anew in every step.
HypothesisFit search_hypothesis(const SearchGround& ground, ReadingModel& model,
                                const Hypothesis& hypothesis, const std::vector<Unknown>& own,
                                const std::vector<double>& beginning);

}  // namespace strut
