// Fisher information of measurements with independent Gaussian noise, and the Cramer-Rao bound.
//
//   F = sum over measurements of (dy/dp)' (dy/dp) / sigma^2,   cov(p) >= F^-1
//
// (S. M. Kay, Fundamentals of Statistical Signal Processing: Estimation Theory, 1993, eqs. 3.20 and
// 3.31). Parameters are in per cent of their base value, so F has the unit 1/%^2.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <vector>

#include "base/math/eigen_abi.h"

namespace strut {

/// Minimum information of a direction, as a fraction of the largest, after scaling F to a unit
/// diagonal. Below it is rounding error: differences are exact to about 1e-6, F to its square.
inline constexpr double kMinInformation = 1e-12;

struct Bounds {
  /// Standard error of each parameter, sqrt(diag(F^-1)) [%]; infinite where the measurements do not
  /// identify it.
  std::vector<double> bound;
  double rms = 0.0;             // over the parameters [%]; the A-optimal criterion
  double condition = 0.0;       // largest over smallest eigenvalue of F; infinite where singular
  int rank = 0;                 // number of directions that the measurements resolve
  std::vector<double> weakest;  // unit vector: the least known combination of parameters (in %)
  double weakest_bound = 0.0;   // along it, 1 / sqrt(smallest eigenvalue) [%]; infinite if singular
};

/// Pseudoinverse of F, the Fisher information.
struct InformationInverse {
  Eigen::MatrixXd covariance;  // over the resolved directions
  std::vector<bool> free;      // parameters with a component in a direction that F does not resolve
  int rank = 0;                // number of resolved directions
};

/// Inverts F by the eigenvectors of F scaled to a unit diagonal, D F D = V diag(l) V':
/// F^-1 = D V diag(1 / l) V' D, without the directions whose l is below kMinInformation of the
/// largest. F symmetric positive semidefinite, in any units.
InformationInverse invert_information(const Eigen::MatrixXd& information);

/// Calculates the Cramer-Rao bounds of a symmetric positive semidefinite F. The bounds do not
/// depend on the scale of the parameters; condition and weakest combination do.
Bounds calc_bounds(const Eigen::MatrixXd& information);

/// The A-optimal criterion sqrt(trace((F + prior)^-1) / n) [%]. The weak prior (1e4 %) only ranks
/// sets of measurements that do not identify every parameter. Allocates once, for its size.
class SpreadCriterion {
 public:
  explicit SpreadCriterion(Eigen::Index size);
  double calc(const Eigen::MatrixXd& information);

 private:
  Eigen::LLT<Eigen::MatrixXd> factor_;
  Eigen::MatrixXd inverse_;
};

}  // namespace strut
