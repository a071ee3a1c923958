// A grid of parameter values that is never enumerated: a case id is a mixed-radix number, first
// axis slowest.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace strut {

/// `count` values from `from` in steps of `step`. Sampling between the levels uses only the bounds.
struct Axis {
  std::string name;  // a parameter (model_files/parameters.h)
  double from = 0.0;
  double step = 0.0;
  std::int64_t count = 1;

  double calc_value(std::int64_t level) const { return from + static_cast<double>(level) * step; }
  double last() const { return calc_value(count - 1); }
};

class Grid {
 public:
  Grid() = default;
  /// Throws InputError where the number of points exceeds an int64.
  explicit Grid(std::vector<Axis> axes);

  const std::vector<Axis>& axes() const { return axes_; }
  std::int64_t size() const { return size_; }
  /// Level of each axis at grid point `id`; levels.size() == axes().size().
  void calc_levels(std::int64_t id, std::span<std::int64_t> levels) const;
  std::int64_t calc_id(std::span<const std::int64_t> levels) const;

 private:
  std::vector<Axis> axes_;
  std::int64_t size_ = 0;
};

}  // namespace strut
