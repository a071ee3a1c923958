// How far off an identified parameter may be.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "base/math/normal.h"
#include "io/file/row_store.h"
#include "train/model/model_file.h"

namespace strut {

/// Probability with which an interval holds the true value.
inline constexpr double kCoverage = 0.95;

/// The ceil((n + 1) coverage)-th smallest of n absolute errors, which keeps the promise
/// P(|error of a new case| <= width) >= coverage for any distribution, as long as the new case is
/// drawn as those were (split conformal prediction: V. Vovk, A. Gammerman, G. Shafer, Algorithmic
/// Learning in a Random World, Springer 2005; J. Lei, M. G'Sell, A. Rinaldo, R. J. Tibshirani, L.
/// Wasserman, JASA 113 (2018) 1094-1111, algorithm 2). Infinite where that is more than n: 0.95
/// asks for 19 errors.
class ConformalWidth {
 public:
  explicit ConformalWidth(std::size_t errors, double coverage = kCoverage);
  /// Takes one of the errors. Only the largest are kept: memory is (1 - coverage) of theirs.
  void add(double error);
  /// Once all are added.
  double get() const;

 private:
  std::size_t keep_;             // how many of the largest; 0: no width is wide enough
  std::vector<double> largest_;  // min-heap
};

/// Per target half the width of the interval of 95 %, in the target's unit. `validation`: rows as
/// recorded, the model's inputs before its targets, that did not train it. The weights are those at
/// the validation minimum, a choice among some hundred epochs by these very rows, so that the
/// promise above holds not to the letter; docs/identify.md has what was measured.
std::vector<double> calc_ci95(const TrainedModel& model, const RowStore& validation);

}  // namespace strut
