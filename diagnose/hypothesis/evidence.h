// Tests hypotheses on the residuals of a fitted model, to first order: the score test
// (C. R. Rao, Proc. Camb. Phil. Soc. 44 (1948)) of all at once.
//
// With whitened residual r, Jacobian J of what the model may adjust, and the response g of the
// readings to a hypothesis,
//
//   chi2 falls by z' K^-1 z,  z = -g' P r,  K = g' P g,  P = I - J (J'J)^-1 J'
//
// under the null hypothesis z is normal with covariance K.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "base/math/eigen_abi.h"
#include "diagnose/hypothesis/hypothesis.h"
#include "diagnose/noise/whitener.h"

namespace strut {

/// One beginning of one hypothesis: its columns among all.
struct HypothesisTrial {
  std::size_t hypothesis = 0, beginning = 0;
  std::vector<std::size_t> columns;     // one a parameter that switches
  std::vector<std::size_t> parameters;  // which of the hypothesis'
};

/// Sums of products over the readings, from which every fit to first order follows.
struct Evidence {
  std::size_t shared = 0;  // unknowns that all runs share, in front
  std::vector<HypothesisTrial> trials;
  /// By run: products of shared unknowns, columns and residual (in this order), less what the run's
  /// own unknowns can take; last: of the priors.
  std::vector<Eigen::MatrixXd> products;

  std::size_t run_count() const { return products.size() - 1; }
};

/// After the shared unknowns are adjusted.
struct Score {
  Eigen::MatrixXd covariance;  // K
  Eigen::VectorXd gradient;    // z
  double chi2 = 0.0;           // of the residual
  Eigen::VectorXd norm;        // K's diagonal before anything was adjusted
};

/// The score over the runs, each counted `weight` times.
Score calc_score(const Evidence& evidence, const std::vector<double>& weights);

/// The fall of chi2 with these columns; 0 where they point to what cannot be, or change nothing
/// that the model could not adjust. `amplitude`: the best, in units of the beginning.
struct Gain {
  double chi2 = 0.0;
  Eigen::VectorXd amplitude;
};
Gain calc_gain(const Score& score, const std::vector<std::size_t>& columns, bool one_sided);

}  // namespace strut
