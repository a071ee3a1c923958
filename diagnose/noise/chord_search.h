// Least squares near a minimum if derivatives cost far more than residuals: Gauss-Newton that keeps
// the Jacobian of one point for many steps (the chord method; C. T. Kelley, Iterative Methods
// for Linear and Nonlinear Equations, 1995, section 5.4.1).
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "base/math/eigen_abi.h"
#include "diagnose/noise/whitener.h"

namespace strut {

class ChordSearch {
 public:
  /// Searches a model that is not whitened; it must outlive the search. Throws InputError where it
  /// cannot be simulated at `values`.
  ChordSearch(ReadingModel& model, std::vector<double> values);

  /// Steps under a whitener's weights until the linear model's distance to the minimum is below a
  /// tenth of kFitTolerance, or no step lowers chi2. Updates the Jacobian where a step lowers chi2
  /// by less than a quarter of the prediction.
  void search(const Whitener& whitener);

  /// Updates the Jacobian to that at values(), unless it is that already.
  void renew();

  const std::vector<double>& values() const { return values_; }
  std::vector<bool> list_at_bound() const;
  int steps() const { return steps_; }
  /// Whether the last search ended at a kink, where no step lowers chi2 though the Jacobian
  /// predicts a decrease.
  bool at_kink() const { return at_kink_; }
  /// Residual at values(), not whitened.
  const Eigen::VectorXd& residual() const { return residual_; }
  /// The last linearization, not whitened; it may be at an earlier point than values().
  std::shared_ptr<const Linearization> linearization() const { return at_; }

 private:
  /// Unknowns on a bound, with a descent direction beyond it.
  std::vector<bool> list_held(const Eigen::VectorXd& gradient) const;

  /// Steps by -change (in scales) if that lowers chi2; returns the decrease, or 0. Null where that
  /// point cannot be simulated.
  std::optional<double> step(const Whitener& whitener, const Eigen::VectorXd& change,
                             Linearization& at);

  ReadingModel& model_;
  std::vector<double> values_, taken_at_;  // the latter: point of at_
  std::shared_ptr<const Linearization> at_;
  Eigen::VectorXd residual_;
  int steps_ = 0;
  bool at_kink_ = false;
};

}  // namespace strut
