// The search for a car and the roads under its runs (latent_road.h) together, and for the level of
// these.
#pragma once

#include <vector>

#include "diagnose/noise/whitened_fit.h"

namespace strut {

/// Fits `unknowns` from `start` and the roads of `result`, whose runs, spectra and number of shared
/// unknowns are set, by Gauss-Newton; completes `result`. `is_noise_known`: the roads' level and
/// the sensors' drift stay as they are, else they are measured. Returns false where the car cannot
/// be simulated on the road that it seems to need.
bool search_roads(const CampaignData& data, const std::vector<Unknown>& unknowns,
                  std::vector<double> start, bool is_noise_known, int threads, WhitenedFit& result);

}  // namespace strut
