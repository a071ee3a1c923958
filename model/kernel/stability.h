// Whether a step is short enough for an integrator to be stable on a car.
#pragma once

#include "model/kernel/simulation.h"

namespace strut {

/// Amplification per step beyond which a run counts as unstable; what a car itself does (a slow
/// drift, a mild unstable mode) stays below.
inline constexpr double kMaxAmplification = 1.005;

/// Factor by which one step of `options` multiplies the worst small disturbance of the start state:
/// the spectral radius of the step's map, differentiated numerically. Multistep formulas count with
/// their history. Not finite where the step itself is not.
double calc_amplification(const PreparedCase& c, const IntegrateOptions& options);

/// The longest step [s] up to `options.step.step` that is not unstable, to 2 %; 0 if none above
/// 1e-6 s.
double find_stable_step(const PreparedCase& c, IntegrateOptions options);

}  // namespace strut
