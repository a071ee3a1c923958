// Levenberg-Marquardt of other libraries, if installed, on the study problem.
#pragma once

#include "tests/train/lm_study_problem.h"

namespace strut {

/// Prints the CPU time to validation MSE 1e-6 from start x0 with GSL (libgsl-dev: lmaccel,
/// Cholesky, exact second derivative) and Ceres (libceres-dev: dense normal equations), on one
/// thread. Residuals and Jacobians come from the kernels of strut.
void run_peers(const test::StudyProblem& study);

}  // namespace strut
