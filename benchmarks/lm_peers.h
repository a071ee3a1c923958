// Other people's Levenberg-Marquardt on the study problem, where it is installed.
#pragma once

#include "tests/train/lm_study_problem.h"

namespace strut {

/// Prints the CPU seconds to validation MSE 1e-6 from one start (x0), with GSL (libgsl-dev:
/// lmaccel, Cholesky, exact second derivative) and Ceres (libceres-dev: dense normal equations), on
/// one thread. Their residuals and Jacobians come from the same kernels as ours.
void run_peers(const test::StudyProblem& study);

}  // namespace strut
