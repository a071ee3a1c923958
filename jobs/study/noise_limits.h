// What no network is needed for: the Cramer-Rao bounds at the test cases, and the simulation fitted
// to their noisy records. Kept in a folder, so that neither is computed twice.
#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include "jobs/study/noise_trainings.h"

namespace strut {

/// A parameter of a case: what it is, and 1 sigma of the best unbiased estimate.
struct NoiseBound {
  double truth = 0.0, bound = 0.0;
};

/// Of one case: a bound for each parameter.
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

struct NoiseLimitsProgress {
  std::atomic<std::size_t> total{0}, done{0};  // cases
};

/// Files of what was computed.
std::filesystem::path find_bounds_file(const std::filesystem::path& folder,
                                       const NoiseSnapshots& snapshots);
std::filesystem::path find_fits_file(const std::filesystem::path& folder, double scale);

/// Computes what `folder` lacks or holds damaged, for the first `request.fits` cases that the
/// networks are tested with, and adds a note for the user where it was damaged. False once `halt`
/// is true; files that are complete stay. No result depends on `threads`. Throws InputError, also
/// where the readings leave a parameter free, and EnvironmentError.
bool update_noise_limits(const NoiseStudyRequest& request, const NoiseStudyData& data,
                         const std::filesystem::path& folder, int threads,
                         NoiseLimitsProgress& progress, std::vector<std::string>& notes,
                         std::atomic<bool>& halt);

/// Bounds of a snapshot with the noise of scale 1, to which they are proportional.
std::vector<BoundedCase> read_bounds(const std::filesystem::path& file,
                                     const std::vector<std::string>& parameters);
std::vector<FittedCase> read_fits(const std::filesystem::path& file,
                                  const std::vector<std::string>& parameters);

}  // namespace strut
