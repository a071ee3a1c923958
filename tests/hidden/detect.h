// Detectability of a fault: its signal-to-noise ratio after all free parameters of a fit are
// adjusted, by the generator's own model at the trial's own truth.
//
// With the whitened deviation d(x) of the runs with the fault from the runs without it whose
// nuisances are off by x, and the nuisances' priors P, s^2 = min over x of |d(x)|^2 + x' P x. It is
// the chi2 that a fit of all channels jointly keeps where the fault is left out; the mean
// improvement by adding the fault is 1 + s^2 (detect_test.cc). Fits that weight channel by channel
// detect less.
#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <vector>

#include "tests/hidden/noise.h"

namespace strut::hidden {

/// A grade of the signal-to-noise ratio s: A >= 30, B >= 10, C >= 5, D below.
char find_grade(double ratio);

/// Unknowns that a fit of the baseline adjusts, without biases, which are removed with the means.
struct Nuisance {
  enum class Kind { kFactor, kSpeed, kTime, kSensorGain, kSensorSkew };
  Kind kind = Kind::kFactor;
  std::size_t index = 0;  // of the kit's parameter, run or sensor
  /// Size of one adjustment, the prior's 1 sigma where there is one: a factor, a fraction of the
  /// speed, a time [s], a gain, a skew [s].
  double unit = 1e-3;
  bool has_prior = false;
};

/// Parameters, speeds, hit times, small errors of sensors.
std::vector<Nuisance> list_nuisances(const Kit& kit);

struct SignalToNoise {
  double ratio = 0.0;  // nuisances adjusted: grades the trial
  double bare = 0.0;   // nothing adjusted
};

/// The runs of a truth without its faults, whitened, and the directions that a fit may adjust.
class Detector {
 public:
  Detector(const Kit& kit, const Truth& truth, std::vector<Nuisance> nuisances);
  Detector(const Kit& kit, const Truth& truth) : Detector(kit, truth, list_nuisances(kit)) {}

  const Kit& kit() const { return kit_; }
  const Truth& truth() const { return truth_; }
  const Whitener& whitener() const { return whitener_; }
  const std::vector<Nuisance>& nuisances() const { return nuisances_; }
  const Runs& base() const { return base_; }
  /// Whitened tangents of the nuisances, and below them one row for each prior.
  const Eigen::MatrixXd& jacobian() const { return jacobian_; }

  /// Whitened deviation from the base of a truth with these faults, whose nuisances are off by x in
  /// their units; then x of the nuisances with priors (0 of the others).
  Eigen::VectorXd calc_deviation(const std::vector<FaultSetting>& faults,
                                 const Eigen::VectorXd& x) const;
  /// The same with the nuisances as they are.
  Eigen::VectorXd calc_deviation(const std::vector<FaultSetting>& faults) const;
  /// The part of a deviation that no nuisance takes, to first order.
  Eigen::VectorXd project(const Eigen::VectorXd& deviation) const;
  /// Residual of the best fit without faults to a deviation.
  Eigen::VectorXd fit(const Eigen::VectorXd& deviation) const;
  SignalToNoise calc(const FaultSetting& fault) const;

  /// Cramer-Rao bounds of the nuisances, 1 sigma in the unit of each: no fit of the baseline to the
  /// runs for fitting has a smaller standard error.
  const std::vector<double>& bounds() const { return bounds_; }

 private:
  /// Takes a step of the adjustments, halved until the residual falls; false where it does not.
  bool improve(const Eigen::VectorXd& deviation, Eigen::VectorXd step, Eigen::VectorXd& x,
               Eigen::VectorXd& residual) const;

  Kit kit_;
  Truth truth_;
  std::vector<Nuisance> nuisances_;
  Runs base_;
  Whitener whitener_;
  Eigen::MatrixXd jacobian_, orthonormal_, root_;  // J = Q R
  std::vector<double> bounds_;
};

}  // namespace strut::hidden
