// Accuracy limits that need no network: the Cramer-Rao bounds at the test cases, and fits of the
// simulation to their noisy records. Files in a folder keep them, so that neither is computed
// twice.
#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include "study/noise/trainings.h"

namespace strut {

/// A parameter of a case: its true value and 1 sigma of the best unbiased estimate, in its unit.
struct NoiseBound {
  double truth = 0.0, bound = 0.0;
};

/// The bounds of one case, one per parameter.
struct BoundedCase {
  std::int64_t number = 0;  // among the usable cases of the data
  std::vector<NoiseBound> parameters;
};

/// A fit to the record of one case.
struct FittedCase {
  BoundedCase bounds;
  std::vector<double> estimates;
  double chi2_per_degree = 0.0, seconds = 0.0;
  bool converged = false;
};

struct NoiseLimitsOptions {
  std::filesystem::path folder;  // folder of the files; must exist
  int threads = 1;               // no result depends on it
};

/// Cases; read by other threads during the computation.
struct NoiseLimitsProgress {
  std::atomic<std::size_t> total{0}, done{0};
};

struct NoiseLimitsSummary {
  bool stopped = false;
  std::vector<std::string> notes;  // for the user: which file was computed anew, and why
};

/// Computes the bounds and fits that the folder lacks or holds damaged, for the first
/// `request.fits` test cases of the networks. Stops once `halt` is true; complete files stay.
/// Throws InputError, also where the readings leave a parameter free, and EnvironmentError.
NoiseLimitsSummary update_noise_limits(const NoiseStudyRequest& request, const NoiseStudyData& data,
                                       const NoiseLimitsOptions& options,
                                       NoiseLimitsProgress& progress, std::atomic<bool>& halt);

}  // namespace strut
