// The residual that a perfect model leaves in every channel of every run.
#pragma once

#include <vector>

#include "diagnose/noise/noise_spectrum.h"

namespace strut {

/// Relative tolerances of noise that is not the sensor's white noise: from a rig's inputs, through
/// the model; drift and mains, of which a run has few periods; and from a car's road, whose
/// roughness varies along the track and reaches a nonlinear car. On hidden trials without a fault
/// the rms is up to 1.9 times the floor on roads of 16e-6 and 64e-6 m^3.
inline constexpr double kInputTolerance = 0.1, kColorTolerance = 1.0, kRoadTolerance = 1.0;

/// Noise of one channel of one run.
struct NoiseFloor {
  double sigma = 0.0;            // standard deviation: sensor, and inputs or road together
  double common_fraction = 0.0;  // fraction of the variance that is not the sensor's white noise
  double uncertainty = 0.0;      // relative standard error of the sensor's sigma
  double common_tolerance = kInputTolerance;  // relative, of the rms, where all of it is common
};

/// Relative tolerance of the rms of `count` readings over their floor, from the uncertainty u of
/// the sensor's noise, the fraction f of other noise with its tolerance t, and the scatter of a
/// finite number of readings:
///
///   1 + tolerance = (1 + 2 u + t f) sqrt(1 + kAdequateSigmas sqrt(2 / count))
inline constexpr double kAdequateSigmas = 4.0;
double calc_floor_tolerance(const NoiseFloor& floor, std::size_t count);

/// Whether more than half of the noise of every channel is the sensor's own: only then a fit that
/// takes all noise for white can be held against priors. Not where a rough road moves the channels.
bool is_mostly_white(const std::vector<NoiseFloor>& floors);

/// The floor of a channel of a run.
NoiseFloor calc_noise_floor(const CampaignData& data, std::size_t run, std::size_t channel,
                            const NoiseSpectrum& spectrum);

/// Floors by run and channel. `spectra`: those of `runs`, the fitted runs; every other run has
/// responses of its own at the shared values, and the level of the fitted ones.
using NoiseFloors = std::vector<std::vector<NoiseFloor>>;
NoiseFloors calc_noise_floors(const CampaignData& data, const std::vector<std::size_t>& runs,
                              const std::vector<NoiseSpectrum>& spectra, const SharedValues& shared,
                              int threads);

/// The floors by the sensors alone, where the model cannot be simulated.
NoiseFloors list_sensor_floors(const CampaignData& data);

/// The spectrum of a run that was not fitted, with the roughness and the excess of the fitted ones.
/// Throws InputError where the run cannot be simulated.
NoiseSpectrum make_spectrum_of_run(const CampaignData& data, std::size_t run,
                                   const std::vector<NoiseSpectrum>& fitted,
                                   const SharedValues& shared);

}  // namespace strut
