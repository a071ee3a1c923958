// Standard errors where the residual is larger in the readings that decide an unknown than on
// average: the model's form is wrong there.
#pragma once

#include <Eigen/Core>

#include "base/math/eigen_abi.h"
#include "estimate/reading_model.h"

namespace strut {

/// By how much the standard error of each unknown grows, at least 1. With C the covariance of
/// readings and priors for residuals as large as `misfit` = chi2 / degrees times their noise, g = J
/// C the influence of the readings, and h their leverage, the part of the readings in an unknown's
/// variance grows by
///
///   max(1, sum_k g_ki^2 r_k^2 / sum_k g_ki^2 (1 - h_k) - 2 sqrt(2 sum_k g_ki^4) / sum_k g_ki^2)
///
/// The fraction is the covariance for residuals of unequal size (H. White, Econometrica 48 (1980)
/// 817) with what the fit takes out of them; the margin is twice the fraction's standard deviation
/// for residuals of equal size, which thus rarely widen anything. No error becomes larger than that
/// of the unknown's prior. Readings that a fit can follow alone (leverage 1) tell nothing. 1
/// throughout where the residuals are not independent. All in units of the unknowns' scales.
Eigen::VectorXd calc_growth(const ReadingModel& model, const Linearization& at,
                            const Eigen::MatrixXd& covariance, const Eigen::MatrixXd& of_priors,
                            double misfit);

}  // namespace strut
