// Readings of one or several runs against their simulation: the model that a fit adjusts.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "base/math/eigen_abi.h"
#include "estimate/unknown.h"

namespace strut {

/// Residuals and their derivatives at one point.
struct Linearization {
  std::string failure;  // why there is no simulation here; empty: all runs got through
  /// (y_sim(t + hit_time) + bias - y_measured) / sigma by run, time and channel; then
  /// (value - mean) / sigma of every prior.
  Eigen::VectorXd residual;
  Eigen::MatrixXd jacobian;  // by unknowns counted in their scale
};

/// Residuals alone, at one of several points.
struct Evaluation {
  std::string failure;       // as Linearization's
  Eigen::VectorXd residual;  // as Linearization's
};

/// Which reading a residual is.
struct ReadingPlace {
  std::size_t run, time, channel;  // the latter of the run's channels
};

/// Simulated readings of all runs against the measured ones, of a car (linearize.h) or a rig
/// (rig_readings.h), by whatever is unknown about them.
class ReadingModel {
 public:
  virtual ~ReadingModel() = default;

  /// `values` in the unknowns' own units. Deterministic.
  virtual Linearization linearize(const std::vector<double>& values) = 0;
  /// The residuals at several points, simulated together; each has a failure of its own.
  virtual std::vector<Evaluation> evaluate(const std::vector<std::vector<double>>& points) = 0;
  /// At one point.
  Evaluation evaluate(const std::vector<double>& values) {
    return evaluate(std::vector<std::vector<double>>{values}).front();
  }
  /// `values` with what costs no search set right, such as the clocks.
  virtual std::vector<double> align(const std::vector<double>& values) { return values; }

  const std::vector<Unknown>& unknowns() const { return unknowns_; }
  /// The places of the first reading_count() residuals, run by run.
  const std::vector<ReadingPlace>& readings() const { return readings_; }
  std::size_t reading_count() const { return readings_.size(); }
  std::size_t prior_count() const { return prior_count_; }
  /// Readings left aside because they lie outside of what is simulated.
  std::size_t outside_count() const { return outside_count_; }
  /// Cases simulated so far.
  long simulation_count() const { return simulation_count_; }
  /// By run: the model's channels that are compared.
  const std::vector<std::vector<int>>& channels() const { return channels_; }

 protected:
  explicit ReadingModel(std::vector<Unknown> unknowns) : unknowns_(std::move(unknowns)) {}
  ReadingModel(const ReadingModel&) = default;
  ReadingModel& operator=(const ReadingModel&) = default;

  /// Fills in the residuals of the priors, after the readings'; and their derivatives.
  void fill_prior_residuals(const std::vector<double>& values, Eigen::VectorXd& residual) const;
  void fill_priors(const std::vector<double>& values, Linearization& out) const;
  /// Throws InputError where there are fewer readings than unknowns; sets prior_count_.
  void finish(const std::string& name);

  std::vector<Unknown> unknowns_;
  std::vector<ReadingPlace> readings_;
  std::vector<std::vector<int>> channels_;
  std::size_t prior_count_ = 0, outside_count_ = 0;
  long simulation_count_ = 0;
};

/// J'J and J'r of a linearization. Unknowns of one run meet only that run's readings, which is
/// most of the work saved.
struct NormalEquations {
  Eigen::MatrixXd information, of_priors;  // the latter: the priors' share of it
  Eigen::VectorXd gradient;
};
NormalEquations calc_normal_equations(const ReadingModel& model, const Linearization& at);

}  // namespace strut
