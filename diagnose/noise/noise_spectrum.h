// The joint noise of all channels of a run. The noise of the sensors is independent; the road's
// roughness, and the measurement noise of a rig's inputs, act on all channels through the model.
//
//   S(f) = diag(sigma^2 (1 + color(f))) + sum_lm C_lm(f) h_l(f) h_m(f)^*
//
// color: drift and mains of the sensors (sensor_color.h); h_l: response of the channels to one
// source l, as amplitudes of the unitary discrete transform; C: cross-spectra of the sources.
// Sources of a car: the road under its wheels, with the density
//
//   G(n) = G0 (n / n0)^-2, n0 = 0.1 1/m (ISO 8608)
//
// The rear wheels follow in the tracks of the front ones, delayed by the wheelbase; the tracks, B
// apart, have the coherence of an isotropic road with this density (C. J. Dodds, J. D. Robson, J.
// Sound Vib. 31 (1973)):
//
//   coherence gamma(n) = x K_1(x), x = 2 pi n B
//
// Both coherences are reduced to 0.9 of this, and the delay is uncertain by 10 ms: no road is
// isotropic, and no rear wheel follows the track to the centimeter. Without coherence, long waves
// would twist the car, which no road does, and bias the measured level. A run is short: S includes
// the leakage of its tapered ends to neighboring frequencies (docs/design/0008-noise-of-a-road.md).
// Sources of a rig: the white noise of each input. Responses are those of the model to a pulse
// small enough to be linear.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "base/math/eigen_abi.h"
#include "diagnose/baseline/baseline.h"
#include "diagnose/noise/sensor_color.h"

namespace strut {

/// Upper ends of the bands in which excess noise is measured [Hz].
inline constexpr std::array<double, 7> kNoiseBands = {0.5, 1.0, 3.0, 8.0, 20.0, 50.0, 1e9};
std::size_t find_noise_band(double frequency);

struct NoiseSpectrum {
  std::size_t samples = 0;         // of the transform, from the start of the run
  double interval = 0.0;           // s, between samples
  std::vector<double> sigma;       // of each channel's white noise
  std::vector<SensorColor> color;  // of each channel's sensor; empty: white
  /// Covariance of the channels by their common sources, per unit of `level`, at the frequencies
  /// 0, 1, ... / (samples * interval), in a record tapered as `fades` says. Zero at frequencies
  /// beyond its end.
  std::vector<Eigen::MatrixXcd> common;
  /// Factor on `common`: G0 [m^3] of a car, 1 of a rig.
  double level = 1.0;
  /// Relative error of the model's responses: the linear response of a nonlinear car is only
  /// approximate.
  double response_error = 0.01;
  /// Whether the record is tapered, which a cut-off record on a rough road needs: its spectrum is
  /// red.
  bool fades = false;
  /// Factor on the variance by kNoiseBands, for errors of the noise model (count_excess).
  std::vector<double> excess = std::vector<double>(kNoiseBands.size(), 1.0);
};

/// Taper of a run's samples: half a period of a cosine over `length` samples at either end, 1
/// between.
std::vector<double> make_fade(std::size_t count, std::size_t length);
/// Its length where NoiseSpectrum::fades and the road is noise: a twentieth of the run.
std::size_t calc_fade_length(std::size_t count);

/// Variance of a channel of a run by `common`, at level 1.
double calc_common_variance(const NoiseSpectrum& spectrum, std::size_t channel);
/// Variance of the noise of a channel of a run, by its sensor and by the common sources.
double calc_noise_variance(const NoiseSpectrum& spectrum, std::size_t channel);

/// The largest length up to n with only the factors 2, 3 and 5, for a fast transform.
std::size_t find_quick_length(std::size_t n);

/// Whether the road continues before and after a record, or its whole effect on the car lies
/// within, as that of a bump does.
enum class RoadRecord { kCutOff, kWithin };

/// Spectra of `runs` at these values of their unknowns (Unknown::run counts within `runs`).
std::vector<NoiseSpectrum> make_noise_spectra(const CampaignData& data,
                                              const std::vector<std::size_t>& runs,
                                              const std::vector<Unknown>& unknowns,
                                              const std::vector<double>& values,
                                              RoadRecord record = RoadRecord::kCutOff,
                                              int threads = 1);

}  // namespace strut
