// Allowances of the intervals of the model's own parameters: for effects too small to be detected,
// and for a force of unknown form, which may in part look like stiffness or damping.
#pragma once

#include <cstddef>
#include <vector>

#include "diagnose/hypothesis/evidence.h"
#include "estimate/fit.h"

namespace strut {

/// An effect that may act without having been detected. To first order, an effect of size s, in
/// standard deviations of its own estimate, gives its score the mean s, and its estimate corrects
/// the model's parameters by s times `shift`.
struct Undetected {
  double prior = 0.0;  // odds that it acts, against no effect at all
  double score = 0.0;  // t = z / sqrt(K) (evidence.h), standard normal without the effect
  bool one_sided = false;
  std::vector<double> shift;  // of each shared unknown, in its unit
};

/// Returns one entry per start and switching parameter of every hypothesis that the readings
/// distinguish from the unknowns; the hypotheses have equal prior odds, which sum to one. `misfit`:
/// factor on the variance of the readings' noise.
std::vector<Undetected> list_undetected(const Evidence& evidence,
                                        const std::vector<bool>& one_sided,
                                        const std::vector<Unknown>& unknowns, double misfit);

struct Interval {
  double low = 0.0, high = 0.0;
};

/// Returns the central 95 % interval of unknown `i` about `value`, averaged over no effect and each
/// undetected one (J. A. Hoeting et al., Stat. Sci. 14 (1999) 382), extended to contain
/// value +- 1.96 sigma:
///
///   p(x) ~ N(x; value, sigma) + sum_h prior_h integral d ln s / L exp(s t_h - s^2 / 2)
///                                     N(x; value + s shift_h, sigma)
///
/// The prior of the size s is log-uniform over four decades, L = ln 10^4; the integral begins at
/// s = 0.3. Without a finite sigma, value +- 1.96 sigma.
Interval calc_averaged_interval(double value, double sigma, std::size_t i,
                                const std::vector<Undetected>& undetected);

/// Returns standard errors of the first `count` unknowns due to a residual of delta chi2 `energy`
/// and unknown form: the force behind it may also have a part that the readings cannot distinguish
/// from unknown i, with a standard deviation of kappa times the residual. It changes the unknown by
///
///   kappa sqrt(energy (H_ii - P_ii)) / H_ii,  H: information, P: that of the priors in it
///
/// at most by a twentieth of the value. kappa = 8 (docs/design/0023-open-intervals.md).
std::vector<double> calc_form_errors(const FitResult& fit, std::size_t count, double energy);

}  // namespace strut
