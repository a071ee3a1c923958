// Fisher information of measurements with independent Gaussian noise, and the Cramer-Rao bound.
//
//   F = sum over measurements of (dy/dp)' (dy/dp) / sigma^2,   cov(p) >= F^-1
//
// (S. M. Kay, Fundamentals of Statistical Signal Processing: Estimation Theory, 1993, eqs. 3.20 and
// 3.31). Parameters are counted in per cent of their base value, so F has the unit 1/%^2.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <vector>

#include "base/math/eigen_abi.h"

namespace strut {

/// Directions whose information is below this share of the largest, after scaling F to a unit
/// diagonal, are rounding: differences carry some 1e-6 of their size, F its square.
inline constexpr double kLeastInformation = 1e-12;

struct Bounds {
  /// 1 sigma of each parameter, sqrt(diag(F^-1)) [%]; infinite where the measurements leave the
  /// parameter free.
  std::vector<double> bound;
  double rms = 0.0;             // % over the parameters; the A-optimal criterion
  double condition = 0.0;       // largest over smallest eigenvalue of F; infinite where singular
  int rank = 0;                 // directions the measurements resolve
  std::vector<double> weakest;  // unit vector: the combination of parameters (in %) known worst
  double weakest_bound = 0.0;  // % along it, 1 / sqrt(smallest eigenvalue); infinite where singular
};

/// F^-1, as far as F has one.
struct InformationInverse {
  Eigen::MatrixXd covariance;  // over the resolved directions
  std::vector<bool> free;      // parameters that take part in a direction F does not resolve
  int rank = 0;                // directions resolved
};

/// F^-1 from the eigenvectors of F scaled to a unit diagonal, D F D = V diag(l) V':
/// F^-1 = D V diag(1 / l) V' D, without the directions whose l is below kLeastInformation of the
/// largest. F symmetric positive semidefinite, in any units.
InformationInverse invert_information(const Eigen::MatrixXd& information);

/// Bounds of a symmetric positive semidefinite F by its eigenvectors. The bounds do not depend on
/// how the parameters are scaled; condition and weakest combination do.
Bounds calc_bounds(const Eigen::MatrixXd& information);

/// sqrt(trace((F + prior)^-1) / n) [%], with a prior so weak (1e4 %) that it only ranks sets of
/// measurements which alone leave a parameter free. Allocates nothing after the first call for a
/// size.
class SpreadCriterion {
 public:
  explicit SpreadCriterion(Eigen::Index size);
  double calc(const Eigen::MatrixXd& information);

 private:
  Eigen::LLT<Eigen::MatrixXd> factor_;
  Eigen::MatrixXd inverse_;
};

}  // namespace strut
