// The roughness of the road, estimated from what a calibrated model leaves.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "diagnose/campaign/campaign_data.h"
#include "diagnose/noise/whitener.h"
#include "estimate/reading_model.h"

namespace strut {

struct Roughness {
  double level = 0.0;           // G0, m^3
  double response_error = 0.0;  // NoiseSpectrum::response_error
};

/// Fits the roughness to the residuals of the runs over level ground, by maximum likelihood over
/// levels from 1e-7 to 1e-3 m^3. `is_level`: by run; true for one at least. `residual`: of the
/// model's readings.
Roughness fit_roughness(const ReadingModel& model, const std::vector<NoiseSpectrum>& spectra,
                        const std::vector<bool>& is_level, const Eigen::VectorXd& residual);

/// Measures the roughness: by fit_roughness if any run is on level ground, otherwise from the
/// samples before the bumps, which no effect of the car reaches:
///
///   G0 = median over runs and channels of (variance / sigma^2 - 1) / (that of a road with G0 = 1)
///
/// Runs with fewer than 50 samples before the bump are ignored. `residual`: of the readings of
/// `model`, whose runs are `runs`, in standard deviations of the sensors.
Roughness measure_roughness(const CampaignData& data, const std::vector<std::size_t>& runs,
                            const ReadingModel& model, const std::vector<NoiseSpectrum>& spectra,
                            const Eigen::VectorXd& residual);

}  // namespace strut
