// Fits a campaign's model with readings weighted by their joint noise, including the road's.
#pragma once

#include <memory>
#include <vector>

#include "diagnose/noise/whitener.h"

namespace strut {

/// chi2 per degree of freedom above which the model's error dominates the noise.
inline constexpr double kDominated = 5.0;

struct WhitenedFit {
  std::vector<std::size_t> runs;
  std::vector<NoiseSpectrum> spectra;
  LatentRoads roads;  // under the runs, where the road is rough; else empty
  std::size_t shared_count = 0;
  FitResult fit;  // the shared unknowns first, then each run's own
  /// The linearization of a car at the fit, not whitened; null for a rig.
  std::shared_ptr<const Linearization> linearization;
  /// The model's error is far larger than the noise; no part of the residual counts as noise.
  bool is_dominated = false;

  SharedValues shared() const;
};

/// Measures the spectra of the runs, with the roughness from the residual of `baseline`.
std::vector<NoiseSpectrum> measure_noise(const CampaignData& data, const Baseline& baseline,
                                         int threads);

/// The noise of some runs. With `roads`, these are unknowns of the runs, from which the search
/// starts; without them, a road is noise with the spectra's density.
struct RunNoise {
  std::vector<NoiseSpectrum> spectra;
  LatentRoads roads{};
  /// With roads: else these, once found, say at which level they are and how the sensors drift.
  bool is_noise_known = false;
};

/// Fits `unknowns` (those that all runs share first) from `start`, and the roads; these are noise
/// again where the car cannot be simulated on what it seems to need. A car without
/// them is fitted a second time, with the excess of the first fit's residual over noise, by band,
/// added to the noise.
WhitenedFit fit_whitened(const CampaignData& data, const std::vector<std::size_t>& runs,
                         const RunNoise& noise, const std::vector<Unknown>& unknowns,
                         const std::vector<double>& start, std::size_t shared_count, int threads);

/// Where the search of a car's fit without roads stands, before excess counts.
struct RoughStart {
  std::vector<double> values;
  bool is_dominated = false;
};
/// From where a fit with roads can begin, if the model's error does not dominate the noise: a road
/// would take what a car that is far off lacks.
RoughStart search_without_roads(const CampaignData& data, const std::vector<std::size_t>& runs,
                                const std::vector<NoiseSpectrum>& spectra,
                                const std::vector<Unknown>& unknowns,
                                const std::vector<double>& start, int threads);

}  // namespace strut
