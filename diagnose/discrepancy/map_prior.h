// Size of a force map, from the readings themselves (empirical Bayes).
//
// Near a fit the whitened readings are r + J p + C t + noise; p: the adjustable parameters of the
// model, C: responses to the shapes of a map, t: their factors. With t_i ~ N(0, s^2 w_i^2), w_i^2 =
// size_g(i)^2 / roughness_i, noise ~ N(0, s^2) and p eliminated, up to a constant
//
//   -2 ln L(size) = n ln Q + ln det(I + W S W),   Q = q - g' W (I + W S W)^-1 W g
//
// S, g, q: products of C and r after projection onto the complement of J; n: number of readings;
// W = diag(w). The sizes of the three groups of shapes, over velocity, over deflection and over
// both, maximize L; 0 for a group that the readings do not support (D. J. C. MacKay, Neural Comput.
// 4 (1992); S. N. Wood, J. R. Stat. Soc. B 73 (2011), 3).
#pragma once

#include <Eigen/Cholesky>
#include <array>

#include "base/math/eigen_abi.h"
#include "diagnose/discrepancy/map_basis.h"

namespace strut {

/// Factors J'J of the adjustable parameters.
Eigen::LDLT<Eigen::MatrixXd> factor_base(const Eigen::MatrixXd& jacobian);

/// The linear model of a map with the adjustable parameters eliminated.
struct MapEvidence {
  Eigen::MatrixXd information;  // S
  Eigen::VectorXd gradient;     // g
  double chi2 = 0.0;            // q
  double count = 0.0;           // n
};

/// Eliminates the adjustable parameters: S = C'C - C'J (J'J)^-1 J'C, g and q likewise, from the
/// responses C to shapes, the Jacobian J of the adjustable parameters (with rows of their priors)
/// and the residual r.
MapEvidence eliminate_base(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& jacobian,
                           const Eigen::VectorXd& residual);

struct MapPrior {
  std::array<double, kMapShares> size{};  // by MapShare
  Eigen::VectorXd weights;                // w
  double log_likelihood = 0.0;            // ln L less that without a map
};

MapPrior choose_map_prior(const MapEvidence& evidence, const std::vector<MapShape>& shapes);

/// The factors of the shapes that maximize their posterior.
Eigen::VectorXd calc_map_mean(const MapEvidence& evidence, const MapPrior& prior);

/// Combinations of shapes that the readings determine, as columns of factors of the shapes, the
/// best determined first. Each has the prior N(0, 1) for readings whose noise is 1.
Eigen::MatrixXd combine_shapes(const MapEvidence& evidence, const MapPrior& prior);

}  // namespace strut
