// Detectability of a fault: its signal-to-noise ratio after all free parameters of a fit are
// adjusted, by the generator's own model and finite differences.
//
// Roughness enters all channels together. The ratio that grades a trial is that of a fit which
// weights each channel by its own spectrum and knows nothing of their coherence, but whose
// threshold is right: with residual r, weights W and covariance S, s = r'Wr / sqrt(r'W S W r). A
// joint treatment detects more; its bound d'S^-1 d is reported as well.
#pragma once

#include <Eigen/Dense>
#include <memory>
#include <string>
#include <vector>

#include "tests/hidden/kit.h"

namespace strut::hidden {

/// A grade of the signal-to-noise ratio s: A >= 30, B >= 10, C >= 5, D below.
char find_grade(double ratio);

/// Covariance of the transforms of all sensors at one frequency [Hz], over samples * sigma^2:
/// sensor noise, the converter's rounding, and on a rough road the response to both tracks by the
/// linearized car, front and rear delayed by the wheelbase.
class NoiseSpectrum {
 public:
  NoiseSpectrum(const Kit& kit, const RunPlan& run, double roughness);
  Eigen::MatrixXcd calc(double frequency) const;

 private:
  const Kit& kit_;
  RunPlan run_;
  double roughness_;
  Eigen::MatrixXd a_, b_, c_, d_;  // states, (height, slope) of four wheels, sensors
};

/// Spectra of the runs for fitting without their means (the sensors' biases), cut above 80 Hz, the
/// last tenth faded out; and their noise.
class Whitener {
 public:
  Whitener(const Kit& kit, double roughness);
  /// Each channel in units of its own noise; real and imaginary parts, times sqrt(2).
  Eigen::VectorXd whiten(const std::vector<std::vector<Signal>>& runs) const;
  /// Variance of the sum over r times whitened noise.
  double calc_variance(const Eigen::VectorXd& r) const;
  /// J' S^-1 J of whitened columns, all channels jointly.
  Eigen::MatrixXd calc_information(const Eigen::MatrixXd& j) const;
  /// d' S^-1 d of a whitened deviation, all channels jointly.
  double calc_joint_square(const Eigen::VectorXd& d) const;

 private:
  /// Calls visit(correlation of the channels, first entry of the whitened vector).
  template <class Visit>
  void visit_bins(const Visit& visit) const;

  const Kit& kit_;
  std::vector<std::size_t> fit_runs_;
  std::vector<std::vector<Eigen::VectorXd>> weight_;        // of each run, of each frequency
  std::vector<std::vector<Eigen::MatrixXcd>> correlation_;  // of the channels' noise
};

/// Signals of all runs for fitting at the kit's rate.
std::vector<std::vector<Signal>> simulate_fit_runs(const Kit& kit, const Truth& truth);

/// Returns a - b.
std::vector<std::vector<Signal>> subtract(std::vector<std::vector<Signal>> a,
                                          const std::vector<std::vector<Signal>>& b);

/// A free parameter of the baseline's fit, or the speed or hit time of a run, as deviations per
/// sigma of its prior, or per 0.1 % where it has none. (Biases are removed with the means.)
struct Nuisance {
  std::vector<std::vector<Signal>> deviation;
  bool has_prior = false;
  double unit = 1.0;  // of the deviations: of a parameter's factor, 1, s
};
std::vector<Nuisance> make_nuisances(const Kit& kit);

struct SignalToNoise {
  double ratio = 0.0;  // channel by channel, nuisances adjusted: grades the trial
  double joint = 0.0;  // the same fit, all channels jointly: a bound
  double bare = 0.0;   // channel by channel, nothing adjusted
};

/// Knows a kit's nuisances on a road.
class Detector {
 public:
  Detector(const Kit& kit, const std::vector<Nuisance>& nuisances, double roughness);
  SignalToNoise calc(const std::vector<std::vector<Signal>>& deviation) const;
  /// Cramer-Rao bounds of the nuisances, 1 sigma in the unit of each: no fit of the baseline to the
  /// runs for fitting has a smaller standard error. At the kit's nominal values, all channels
  /// jointly, up to the highest frequency used.
  const std::vector<double>& bounds() const { return bounds_; }

 private:
  Whitener whitener_;
  Eigen::MatrixXd jacobian_;  // one column per nuisance
  Eigen::LDLT<Eigen::MatrixXd> normal_;
  std::vector<double> bounds_;
};

}  // namespace strut::hidden
