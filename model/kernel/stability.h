// Stability limit of the integrator's step for a car.
#pragma once

#include "model/kernel/simulation.h"

namespace strut {

/// Amplification per step above which a run counts as unstable. The motion of a stable car (slow
/// drift, a mild unstable mode) stays below.
inline constexpr double kMaxAmplification = 1.005;

/// Factor by which one step of `options` amplifies the worst small disturbance of the start state:
/// the spectral radius of the step's Jacobian, by central differences. The Jacobian of a multistep
/// formula includes its history. Not finite where the step is not.
double calc_amplification(const PreparedCase& c, const IntegrateOptions& options);

/// The longest stable step [s] up to `options.step.step`, to 2 %; 0 where 1e-6 s is unstable.
double find_stable_step(const PreparedCase& c, IntegrateOptions options);

}  // namespace strut
