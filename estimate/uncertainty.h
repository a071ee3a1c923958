// Uncertainty of the unknowns, from the Jacobian of the readings.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "base/math/eigen_abi.h"
#include "estimate/unknown.h"

namespace strut {

/// A combination of unknowns that the readings do not identify.
struct NullDirection {
  std::vector<double> parts;  // unit vector, by unknowns in units of their scale
  double sigma = 0.0;         // along it, in scales; infinite where nothing depends on it
};

struct Uncertainty {
  /// (J'J)^-1 in the unknowns' own units; zero rows for unknowns without information.
  Eigen::MatrixXd covariance;
  std::vector<double> sigma;                   // sqrt of its diagonal; infinite without information
  std::vector<bool> identifiable;              // sigma at most the unknown's scale
  int rank = 0;                                // number of unknowns less null directions
  std::vector<NullDirection> null_directions;  // sigma above 100 %, worst first

  double calc_correlation(std::size_t i, std::size_t j) const;
};

/// Calculates the uncertainty from the information J'J of the scaled Jacobian (reading_model.h),
/// for independent Gaussian noise; at the true values the Cramer-Rao bound (S. M. Kay, Estimation
/// Theory, 1993, eq. 3.31; with priors the Bayesian one of H. L. Van Trees, 1968, section 2.4.3).
Uncertainty calc_uncertainty(const Eigen::MatrixXd& information,
                             const std::vector<Unknown>& unknowns);

/// Whether a standard error is at most the unknown's scale.
bool is_identifiable(double sigma, const Unknown& u);

/// "front_stiffness - 0.98 rear_stiffness": the components above 0.1.
std::string describe_direction(const NullDirection& direction,
                               const std::vector<Unknown>& unknowns);

/// The same for each null direction.
std::vector<std::string> describe_null_directions(const Uncertainty& uncertainty,
                                                  const std::vector<Unknown>& unknowns);

}  // namespace strut
