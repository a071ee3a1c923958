// Min-max normalization of columns: equation 4 of Pan, Sun, Min, Li, Gardoni, onto [-1, 1].
#pragma once

#include <span>
#include <string>
#include <vector>

namespace strut {

/// z = -1 + 2 (x - low) / (high - low) per column. The paper maps onto [0, 1], and the toolbox that
/// it uses then onto [-1, 1], the range of tansig; this map does both in one.
class Normalizer {
 public:
  explicit Normalizer(std::size_t columns = 0);
  Normalizer(std::vector<double> low, std::vector<double> high);

  std::size_t columns() const { return low_.size(); }
  const std::vector<double>& low() const { return low_; }
  const std::vector<double>& high() const { return high_; }

  /// Extends the bounds to include rows of columns() values.
  void include(std::span<const double> rows);
  /// First column without a range (all values equal, or none yet); columns() if there is none.
  std::size_t find_constant() const;

  /// Normalizes rows of columns() values in place.
  void normalize(std::span<double> rows) const;
  /// Inverse of normalize.
  void restore(std::span<double> rows) const;
  /// Distance of row `x` from the bounds, as a fraction of the column's width, maximum over
  /// columns; 0 inside the bounds, NaN for NaN.
  double calc_excess(std::span<const double> x) const;

 private:
  std::vector<double> low_, high_;
};

}  // namespace strut
