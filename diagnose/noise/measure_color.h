// Drift and mains of the sensors, measured by the residual of a fit.
#pragma once

#include <vector>

#include "diagnose/noise/whitener.h"

namespace strut {

/// Sets NoiseSpectrum::color by the residual of the model's readings; leaves it white where the
/// model's error dominates the noise.
void measure_color(const ReadingModel& model, const Eigen::VectorXd& residual,
                   std::vector<NoiseSpectrum>& spectra);

/// Sets the drift of NoiseSpectrum::color by what is left of the readings of `model` beside its
/// runs' roads, whose responses `sensors` knows; the spectra are those of `sensors`, without drift.
/// Whether there is any. A road that takes up a share h of a reading's noise is taken to leave
/// 1 - h of its drift, too: drift among readings that are partly taken up is more, and is
/// underestimated.
bool measure_drift_beside_roads(const ReadingModel& model, const Whitener& sensors,
                                const Eigen::VectorXd& residual,
                                std::vector<NoiseSpectrum>& spectra, int threads = 1);

}  // namespace strut
