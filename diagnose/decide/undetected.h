// What the readings leave open about the model's own parameters: effects may act that are too small
// to be detected, and a force of unknown form may in part look like stiffness and damping.
#pragma once

#include <cstddef>
#include <vector>

#include "diagnose/hypothesis/evidence.h"
#include "estimate/fit.h"

namespace strut {

/// An effect that may act without being detected. To first order, an effect of s standard
/// deviations of its own size gives `score` the mean s, and moves the fit by -s `shift`.
struct Undetected {
  double weight = 0.0;  // prior odds that it acts, against that none does
  double score =
      0.0;  // t = z / sqrt(K) (evidence.h), standard normal where the effect is not there
  bool one_sided = false;
  std::vector<double> shift;  // of each unknown that all runs share, in its unit: what undoes it
};

/// One entry per start and switching parameter of every hypothesis that the readings can tell from
/// the unknowns. One effect or none is equally probable before, each effect as probable as any
/// other. `misfit`: factor on the variance of the noise.
std::vector<Undetected> list_undetected(const Evidence& evidence, const Score& score,
                                        const std::vector<bool>& one_sided,
                                        const std::vector<Unknown>& unknowns, double misfit);

struct Interval {
  double low = 0.0, high = 0.0;
};

/// The central 95 % interval of unknown `i` about `value`, averaged over no effect and every
/// undetected one (J. A. Hoeting et al., Stat. Sci. 14 (1999) 382):
///
///   p(x) ~ N(x; value, sigma) + sum_h w_h integral d ln s / L exp(s t_h - s^2 / 2)
///                                     N(x; value + s shift_h, sigma)
///
/// with s, the size in its standard deviations, log-uniform over L = ln 10^4. It contains
/// value +- 1.96 sigma.
Interval calc_averaged_interval(double value, double sigma, std::size_t i,
                                const std::vector<Undetected>& undetected);

/// Standard errors of the first `count` unknowns where a residual of delta chi2 `energy` has no
/// known form: the force behind it may have a part that looks like unknown i alone, up to kappa
/// times as large in the readings as what is seen of it,
///
///   kappa sqrt(energy / (H_ii - 1 / sigma_i^2)),  H: information, sigma_i: of the prior
///
/// but at most a twentieth of the value. kappa = 8: a compressed gas is 7.5 times as much stiffness
/// as it is anything else (docs/design/0018-uneven-residuals.md).
std::vector<double> calc_form_errors(const FitResult& fit, std::size_t count, double energy);

}  // namespace strut
