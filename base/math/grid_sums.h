// Order statistics of a sum over a grid that is too large to enumerate.
#pragma once

#include <compare>
#include <cstdint>
#include <vector>

namespace strut {

/// One digit of the grid: level i adds i * weight to the sum.
struct SumAxis {
  std::int64_t count = 1;
  std::int64_t weight = 0;  // >= 0
};

/// A grid point in the order of its sum, ties by number.
struct RankedPoint {
  std::int64_t sum = 0;
  std::int64_t id = 0;  // mixed radix of the levels, first axis slowest
  auto operator<=>(const RankedPoint&) const = default;  // NOLINT(modernize-use-nullptr)
};

/// All points of a grid sorted by (sum, id), of which any one is found by its rank. Meet in the
/// middle: the sums of the first axes and those of the last are sorted apart, and a bisection over
/// the sum counts pairs. Memory and time grow with the square root of the grid where its axes can
/// be halved evenly.
class GridSums {
 public:
  /// Largest number of points of either half.
  static constexpr std::int64_t kLargestHalf = std::int64_t{1} << 22;

  /// Throws std::invalid_argument where a half exceeds kLargestHalf; the sum of all axes' largest
  /// and the number of points must fit an int64.
  explicit GridSums(const std::vector<SumAxis>& axes);

  std::int64_t size() const { return size_; }
  /// The point with `rank` points before it, 0 <= rank < size().
  RankedPoint find(std::int64_t rank) const;
  /// The number of points that have a sum of at most `sum`.
  std::int64_t count_up_to(std::int64_t sum) const;

 private:
  std::int64_t find_tie(std::int64_t sum, std::int64_t place) const;

  std::vector<std::int64_t> high_;         // sum of each point of the first axes, by number
  std::vector<std::int64_t> sorted_high_;  // the same, ascending
  std::vector<std::int64_t> sorted_low_;   // of the last axes, ascending
  std::vector<std::int64_t> low_id_;       // whose sum that is; equal sums by number
  std::int64_t size_ = 1;
};

}  // namespace strut
