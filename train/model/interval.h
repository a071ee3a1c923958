// Intervals of identified parameters.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "base/math/normal.h"
#include "io/file/row_store.h"
#include "train/model/model_file.h"

namespace strut {

/// Probability that an interval contains the true value.
inline constexpr double kCoverage = 0.95;

/// The ceil((n + 1) coverage)-th smallest of n absolute errors, which guarantees
/// P(|error of a new case| <= width) >= coverage for any distribution, if the new case is drawn
/// from the same one (split conformal prediction: V. Vovk, A. Gammerman, G. Shafer, Algorithmic
/// Learning in a Random World, Springer 2005; J. Lei, M. G'Sell, A. Rinaldo, R. J. Tibshirani, L.
/// Wasserman, JASA 113 (2018) 1094-1111, algorithm 2). Infinite if n is too small: 0.95 needs 19
/// errors.
class ConformalWidth {
 public:
  explicit ConformalWidth(std::size_t errors, double coverage = kCoverage);
  /// Adds one of the errors. Only the largest fraction 1 - coverage of them is kept in memory.
  void add(double error);
  /// The width, once all errors are added.
  double get() const;

 private:
  std::size_t keep_;             // number of largest errors to keep; 0: the width is infinite
  std::vector<double> largest_;  // min-heap
};

/// Half width of the 95 % interval of each target, in the target's unit. `validation`: recorded
/// rows, the model's inputs, then its targets, that did not train it. Since the weights are those
/// at the validation minimum, selected among about a hundred epochs by these very rows, the
/// guarantee above is only approximate; docs/identify.md gives the measured coverage.
std::vector<double> calc_ci95(const TrainedModel& model, const RowStore& validation);

}  // namespace strut
