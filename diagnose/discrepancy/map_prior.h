// Size and roughness of a force map, from the readings themselves (empirical Bayes).
//
// Near a fit the whitened readings are r + J p + C t + noise, p what the model may adjust anyway, C
// the responses to shapes of a map. With t_i ~ N(0, s^2 w_i^2), w_i^2 = size_g(i)^2 / roughness_i,
// noise ~ N(0, s^2) and p eliminated, up to a constant
//
//   -2 ln L(size) = n ln Q + ln det(I + W S W),   Q = q - g' W (I + W S W)^-1 W g
//
// S, g, q: products of C and r less what p takes; n: how many readings; W = diag(w). The sizes of
// the three shares, that over velocity, over deflection and over both, are those of largest L; 0
// where a share is not asked for (D. J. C. MacKay, Neural Comput. 4 (1992); S. N. Wood, J. R. Stat.
// Soc. B 73 (2011), 3).
#pragma once

#include <Eigen/Cholesky>
#include <array>

#include "base/math/eigen_abi.h"
#include "diagnose/discrepancy/map_basis.h"

namespace strut {

/// J'J of what else may be adjusted, factored.
Eigen::LDLT<Eigen::MatrixXd> factor_base(const Eigen::MatrixXd& jacobian);

/// The linear model of a map with all else eliminated.
struct MapEvidence {
  Eigen::MatrixXd information;  // S
  Eigen::VectorXd gradient;     // g
  double chi2 = 0.0;            // q
  double count = 0.0;           // n
};

/// Eliminates all else: C'C - C'J (J'J)^-1 J'C and so on, of the responses C to shapes, the
/// derivatives J by what else may be adjusted (with rows of its priors) and the residual r.
MapEvidence eliminate_base(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& jacobian,
                           const Eigen::VectorXd& residual);

struct MapPrior {
  std::array<double, kMapShares> size{};  // by MapShare
  Eigen::VectorXd weights;                // w
  double log_likelihood = 0.0;            // ln L over that without a map
};

MapPrior choose_map_prior(const MapEvidence& evidence, const std::vector<MapShape>& shapes);

/// The factors of the shapes where their posterior is highest.
Eigen::VectorXd calc_map_mean(const MapEvidence& evidence, const MapPrior& prior);

/// Shapes that the readings tell, combined so that each has the prior N(0, 1) of readings whose
/// noise is 1: columns of factors of the shapes, the best told first.
Eigen::MatrixXd combine_shapes(const MapEvidence& evidence, const MapPrior& prior);

}  // namespace strut
