// The noise of all channels of a run together. Sensors are noisy each for itself; the road's
// roughness, and the noise of what a rig's inputs were measured with, reach all channels at once,
// through the model.
//
//   S(f) = diag(sigma^2) + sum_lm C_lm(f) h_l(f) h_m(f)^*
//
// h_l: response of the channels to one source l, as amplitudes of the unitary discrete transform;
// C: how alike the sources are. Sources of a car: the road under its wheels, with the density
//
//   G(n) = G0 (n / n0)^-2, n0 = 0.1 1/m (ISO 8608)
//
// the rear wheels in the tracks of the front ones, a wheelbase later, and the tracks, B apart, as
// alike as those of an isotropic road with this density (C. J. Dodds, J. D. Robson, J. Sound Vib.
// 31 (1973)):
//
//   coherence gamma(n) = x K_1(x), x = 2 pi n B
//
// Only 0.9 of either is relied upon, and a delay that is known to 10 ms, no more: no road is
// isotropic, and no rear wheel runs in the track to the centimeter. Without it long waves would
// twist the car, which no road does, and the measured level would pay for that. A run is short:
// what its faded ends spread over neighboring frequencies is in S, too
// (docs/design/0008-noise-of-a-road.md). Sources of a rig: the white noise of each input. Responses
// are the model's own, to a pulse so small that it is linear.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "base/math/eigen_abi.h"
#include "diagnose/baseline/baseline.h"

namespace strut {

/// Hz, the upper ends of bands over which what noise models do not know is told apart.
inline constexpr std::array<double, 7> kNoiseBands = {0.5, 1.0, 3.0, 8.0, 20.0, 50.0, 1e9};
std::size_t find_noise_band(double frequency);

struct NoiseSpectrum {
  std::size_t samples = 0;    // of the transform: the first of the run's
  double interval = 0.0;      // s between them
  std::vector<double> sigma;  // of each channel's white noise
  /// By frequency 0, 1, ... / (samples interval), per level: the covariance of the channels by all
  /// that reaches them at once, in a record that is faded in and out where it is. None beyond the
  /// end.
  std::vector<Eigen::MatrixXcd> common;
  /// Factor on `common`: G0 [m^3] of a car, 1 of a rig.
  double level = 1.0;
  /// Relative error of the model's responses against those of the car. The linear
  /// response of a nonlinear car is not exact, and must not be relied on to the last digit.
  double response_error = 0.01;
  /// A rough road's spectrum is red: a record that is cut off must be faded out.
  bool fades = false;
  /// By kNoiseBands: what the variance is to be multiplied by beyond the above, for what the noise
  /// model does not know (count_excess).
  std::vector<double> excess = std::vector<double>(kNoiseBands.size(), 1.0);
};

/// Factors on the samples of a run: half a period of a cosine over a twentieth of it at either end;
/// 1 where it is not faded.
std::vector<double> make_fade(std::size_t count, bool fades);

/// Variance that `common` gives a channel of a run, at level 1.
double calc_common_variance(const NoiseSpectrum& spectrum, std::size_t channel);
/// Variance of the noise of a channel of a run, the sensor's own and what it has in common with
/// others.
double calc_noise_variance(const NoiseSpectrum& spectrum, std::size_t channel);

/// The largest number up to n whose transform is quick: of factors 2, 3, 5.
std::size_t find_quick_length(std::size_t n);

/// Whether a road goes on before and after a record, or all that it does to a car lies within, as
/// of a bump.
enum class RoadRecord { kCutOff, kWithin };

/// Spectra of `runs` at these values of their unknowns (Unknown::run counts within `runs`).
std::vector<NoiseSpectrum> make_noise_spectra(const CampaignData& data,
                                              const std::vector<std::size_t>& runs,
                                              const std::vector<Unknown>& unknowns,
                                              const std::vector<double>& values,
                                              RoadRecord record = RoadRecord::kCutOff);

}  // namespace strut
