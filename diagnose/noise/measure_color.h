// Drift and mains of the sensors, measured by the residual of a fit.
#pragma once

#include <vector>

#include "diagnose/noise/noise_spectrum.h"
#include "estimate/reading_model.h"

namespace strut {

/// Sets NoiseSpectrum::color by the residual of the model's readings; leaves it white where the
/// model's error dominates the noise.
void measure_color(const ReadingModel& model, const Eigen::VectorXd& residual,
                   std::vector<NoiseSpectrum>& spectra);

}  // namespace strut
