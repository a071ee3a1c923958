// Fits one hypothesis together with the unknowns of a fit, by damped Gauss-Newton. Sizes are scaled
// by their start values; positive shapes are fitted by their logarithm, since they are known only
// up to a factor. Every shape has a prior with sigma 1 about its start value.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <string>
#include <vector>

#include "base/math/eigen_abi.h"
#include "diagnose/hypothesis/hypothesis.h"
#include "diagnose/noise/whitener.h"

namespace strut {

/// The fit of a hypothesis together with the adjustable parameters.
struct HypothesisFit {
  std::string failure;         // empty: it could be simulated
  std::vector<double> values;  // of the base unknowns, then of the hypothesis' parameters
  std::vector<double> sigma;   // standard errors of the hypothesis' parameters
  double gain = 0.0;           // delta chi2
  /// Distance to the minimum of the linear model, in standard deviations for noise as large as the
  /// residuals.
  double distance = 0.0;
  bool converged = false;  // within kFitTolerance, or kKinkTolerance where no step lowers chi2
  long simulations = 0;
};

/// When a search stops.
struct SearchEffort {
  int steps = 60;         // max
  double distance = 0.1;  // of HypothesisFit
};

/// The fit from which a search starts. All references must outlive the search.
struct SearchGround {
  bool has_inputs = false;
  const std::vector<Unknown>& unknowns;
  const std::vector<double>& values;
  const Whitener& whitener;
  const Eigen::VectorXd& residual;  // whitened, then priors
  const Eigen::MatrixXd& jacobian;  // by unknowns in their scale
  const Eigen::MatrixXd& normal;    // J'J
  const Eigen::LDLT<Eigen::MatrixXd>& regular_normal;
};

/// `model` has the unknowns of `ground`, followed by the hypothesis' `own`. For a car, the
/// derivatives with respect to the former stay those of `ground`; for a rig, all are updated: by
/// differences where a step disappoints, else by the step itself (C. G. Broyden, Math. Comp. 19
/// (1965)). On a road that was found, the search moves the hypothesis alone, with Broyden's update,
/// and the others by their derivatives; only where that is more than 3 standard deviations do the
/// simulations have it. The search starts at the best of several fractions of `beginning`, the
/// center of the shapes' priors; or at `from`, values of all unknowns.
HypothesisFit search_hypothesis(const SearchGround& ground, ReadingModel& model,
                                const Hypothesis& hypothesis, const std::vector<Unknown>& own,
                                const std::vector<double>& beginning,
                                const SearchEffort& effort = {},
                                const std::vector<double>& from = {});

}  // namespace strut
