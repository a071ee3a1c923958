// White noise for tests of linear models.
#pragma once

#include "diagnose/noise/noise_spectrum.h"

namespace strut::test {

/// White noise of 1 sigma for one channel of `samples` readings, below the whitener's highest
/// frequency: whitening keeps every product of readings.
inline NoiseSpectrum make_unit_noise(std::size_t samples) {
  NoiseSpectrum noise;
  noise.samples = samples;
  noise.interval = 0.01;
  noise.sigma = {1.0};
  return noise;
}

}  // namespace strut::test
