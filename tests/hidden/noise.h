// Noise of a trial's readings at its truth: spectra of all channels together, and whitening by
// them.
#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <vector>

#include "tests/hidden/simulate_kit.h"

namespace strut::hidden {

/// Signals of the runs for fitting: of each run, of each sensor.
using Runs = std::vector<std::vector<Signal>>;

/// Seconds of every signal before and after the recording, as in the files' simulation.
inline constexpr double kMargin = 0.04;

std::vector<std::size_t> find_fit_runs(const Kit& kit);

/// Noise-free signals at the kit's rate, with the trial's own roughness.
Runs simulate_fit_runs(const Kit& kit, const Truth& truth);

/// Returns a - b.
Runs subtract(Runs a, const Runs& b);

/// Covariance of the transforms of all outputs at one frequency, over the number of samples:
/// S = T (diag(sigma^2 (1 + drift(f)) + q^2 / 12) + sigma_j^2 mean(y' y'^T)) T^* + road.
///
/// sigma: sensor noise, drift: its 1/f part (a line of the mains is left out: nothing moves there),
/// q: step of the converter, sigma_j: jitter of the clock, which all channels
/// of a file share, y': rates of the true signals. T = [-h 1] on a stand, h the response of the
/// outputs to the input: the motion is unknown but for its measurement. road: the response of the
/// linearized car to both tracks, front and rear delayed by the wheelbase; the road is unknown but
/// for its spectrum.
class NoiseSpectrum {
 public:
  /// `signals`: the run without noise, with a rate for the jitter.
  NoiseSpectrum(const Kit& kit, const Truth& truth, std::size_t run,
                const std::vector<Signal>& signals);
  Eigen::MatrixXcd calc(double frequency) const;  // Hz

 private:
  Eigen::MatrixXd calc_readings(double frequency) const;
  Eigen::MatrixXcd calc_rig(double frequency) const;
  Eigen::MatrixXcd calc_road(double frequency) const;

  const Kit& kit_;
  Truth truth_;
  RunPlan run_;
  double speed_ = 0.0;             // m/s
  Eigen::MatrixXd readings_;       // covariance of a sample of all channels
  Eigen::MatrixXd a_, b_, c_, d_;  // states, (height, slope) of four wheels, sensors
};

/// Whitens the runs for fitting by their noise, all channels jointly: independent entries of
/// variance 1. The sensors' biases, the means of the runs, are removed. A car's runs are faded in
/// and out over a twentieth each, since its spectra are steep.
class Whitener {
 public:
  /// `base`: the truth's runs without noise.
  Whitener(const Kit& kit, const Truth& truth, const Runs& base);
  /// Real and imaginary parts of all bins below half the rate.
  Eigen::VectorXd whiten(const Runs& runs) const;
  /// Readings against the model of a stand that is driven by the measured input: outputs less the
  /// response to the input's deviation. No effect on a car.
  Eigen::VectorXd whiten_residuals(const Runs& runs) const;

 private:
  Eigen::VectorXd whiten(const Runs& runs, bool has_measured_input) const;

  const Kit& kit_;
  Truth truth_;
  std::vector<std::size_t> fit_runs_;
  std::vector<std::vector<Eigen::MatrixXcd>> inverse_root_;  // of each run, of each frequency
};

}  // namespace strut::hidden
