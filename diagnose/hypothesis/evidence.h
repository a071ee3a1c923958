// Tests hypotheses on the residuals of a fitted model, to first order: the score test
// (C. R. Rao, Proc. Camb. Phil. Soc. 44 (1948)) of all at once.
//
// With whitened residual r, Jacobian J of the adjustable parameters, and the response g of the
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

/// One start of one hypothesis, and its columns among all.
struct HypothesisTrial {
  std::size_t hypothesis = 0, beginning = 0;
  std::vector<std::size_t> columns;     // one per switching parameter
  std::vector<std::size_t> parameters;  // their indices in Hypothesis::parameters
};

/// Sums of products over the readings, from which every fit to first order follows.
struct Evidence {
  std::size_t shared = 0;  // number of unknowns that all runs share, which come first
  std::vector<HypothesisTrial> trials;
  /// By run: products of shared unknowns, columns and residual (in this order), with the run's own
  /// unknowns eliminated; last: those of the priors.
  std::vector<Eigen::MatrixXd> products;
  std::vector<Eigen::VectorXd> norms;  // by run: squares of the columns before any elimination

  std::size_t run_count() const { return products.size() - 1; }
};

/// The score statistic, with the shared unknowns eliminated.
struct Score {
  Eigen::MatrixXd covariance;  // K
  Eigen::VectorXd gradient;    // z
  double chi2 = 0.0;           // of the residual
  Eigen::VectorXd norm;        // diagonal of K without any elimination, of a run's own unknowns too
  /// By column, the change of the shared unknowns, in their scale, that compensates for it.
  Eigen::MatrixXd correction;
};

/// The score over the runs, run i weighted by `weights[i]`.
Score calc_score(const Evidence& evidence, const std::vector<double>& weights);

/// Whether the readings distinguish a column from the adjustable parameters.
bool is_seen(const Score& score, Eigen::Index column);

/// The delta chi2 of these columns; 0 where their best amplitude has the wrong sign (`one_sided`),
/// or the adjustable parameters have the same effect. `amplitude`: the best, in units of the start.
struct Gain {
  double chi2 = 0.0;
  Eigen::VectorXd amplitude;
};
Gain calc_gain(const Score& score, const std::vector<std::size_t>& columns, bool one_sided);

}  // namespace strut
