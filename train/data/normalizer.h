// Min-max normalization of columns: equation 4 of Pan, Sun, Min, Li, Gardoni, onto [-1, 1].
#pragma once

#include <span>
#include <string>
#include <vector>

namespace strut {

/// z = -1 + 2 (x - low) / (high - low) per column. The paper maps onto [0, 1], and the toolbox it
/// names then onto [-1, 1], where tansig is at home; one map does both.
class Normalizer {
 public:
  explicit Normalizer(std::size_t columns = 0);
  Normalizer(std::vector<double> low, std::vector<double> high);

  std::size_t columns() const { return low_.size(); }
  const std::vector<double>& low() const { return low_; }
  const std::vector<double>& high() const { return high_; }

  /// Widens the bounds by rows of columns() values.
  void include(std::span<const double> rows);
  /// First column whose values are all equal (or that has none), columns() where there is none.
  std::size_t find_constant() const;

  /// In place, rows of columns() values.
  void normalize(std::span<double> rows) const;
  void restore(std::span<double> rows) const;
  /// How far row `x` lies outside of the bounds, largest over columns, as a share of the column's
  /// width; 0 inside.
  double calc_excess(std::span<const double> x) const;

 private:
  std::vector<double> low_, high_;
};

}  // namespace strut
