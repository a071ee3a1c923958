// The fit of a campaign's model that weighs its readings by all their noise, roads included.
#pragma once

#include <memory>
#include <vector>

#include "diagnose/noise/whitener.h"

namespace strut {

/// chi2 per degree of freedom beyond which noise no longer matters.
inline constexpr double kDominated = 5.0;

struct WhitenedFit {
  std::vector<std::size_t> runs;
  std::vector<NoiseSpectrum> spectra;
  std::size_t shared_count = 0;
  FitResult fit;  // the shared unknowns first, then each run's own
  /// The linearization of a car at the fit, not whitened; null of a rig.
  std::shared_ptr<const Linearization> linearization;
  /// The model's error is far larger than the noise: all of it counts alike, nothing as noise.
  bool is_dominated = false;

  SharedValues shared() const;
};

/// Spectra of the runs with the level of roughness that the residual of `baseline` has.
std::vector<NoiseSpectrum> measure_noise(const CampaignData& data, const Baseline& baseline);

/// Fits `unknowns` (those that all runs share in front) beginning at `start`; of a car again with
/// what the first fit leaves in each band beyond its noise counted as noise.
WhitenedFit fit_whitened(const CampaignData& data, const std::vector<std::size_t>& runs,
                         const std::vector<NoiseSpectrum>& spectra,
                         const std::vector<Unknown>& unknowns, const std::vector<double>& start,
                         std::size_t shared_count, int threads);

}  // namespace strut
