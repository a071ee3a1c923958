// Least squares near a minimum where derivatives cost far more than residuals: Gauss-Newton with
// the derivatives of one point for many steps (the chord method; C. T. Kelley, Iterative Methods
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

  /// Steps under a whitener's weights until the linear model sees less than a tenth of
  /// kFitTolerance to the minimum, or no step helps. Derivatives are taken anew where a step gains
  /// less than a quarter of what they promise.
  void search(const Whitener& whitener);

  /// Takes the derivatives where it stands, unless they are of there.
  void renew();

  const std::vector<double>& values() const { return values_; }
  std::vector<bool> list_at_bound() const;
  int steps() const { return steps_; }
  /// The last search ended where no step lowers chi2 though its derivatives promise it: a kink.
  bool at_kink() const { return at_kink_; }
  /// At values(), not whitened.
  const Eigen::VectorXd& residual() const { return residual_; }
  /// Where derivatives were last taken, not whitened.
  std::shared_ptr<const Linearization> linearization() const { return at_; }

 private:
  /// Unknowns on a bound beyond which the slope leads.
  std::vector<bool> list_held(const Eigen::VectorXd& gradient) const;

  /// Goes by -change (in scales) where that lowers chi2, and returns by how much; else 0. Nothing
  /// where that point cannot be simulated.
  std::optional<double> step(const Whitener& whitener, const Eigen::VectorXd& change,
                             Linearization& at);

  ReadingModel& model_;
  std::vector<double> values_, taken_at_;  // the latter: where at_ is
  std::shared_ptr<const Linearization> at_;
  Eigen::VectorXd residual_;
  int steps_ = 0;
  bool at_kink_ = false;
};

}  // namespace strut
