// Order statistics of a sum over a grid that is too large to enumerate.
#pragma once

#include <compare>
#include <cstdint>
#include <vector>

namespace strut {

/// One axis of the grid: level i adds i * weight to the sum.
struct SumAxis {
  std::int64_t count = 1;
  std::int64_t weight = 0;  // >= 0
};

/// A grid point, ordered by its sum; ties are ordered by id.
struct RankedPoint {
  std::int64_t sum = 0;
  std::int64_t id = 0;  // mixed-radix number of the levels, first axis slowest
  auto operator<=>(const RankedPoint&) const = default;  // NOLINT(modernize-use-nullptr)
};

/// Finds points of a grid by their rank in the order of (sum, id). Meet in the middle: the sums of
/// the first axes and those of the last axes are sorted separately, and a bisection over the sum
/// counts pairs. Memory and time grow with the square root of the grid size where its axes split
/// into equal halves.
class GridSums {
 public:
  /// Maximum number of points of either half.
  static constexpr std::int64_t kMaxHalf = std::int64_t{1} << 22;

  /// Throws std::invalid_argument where a half exceeds kMaxHalf; the maximum sum and the number of
  /// points must fit an int64.
  explicit GridSums(const std::vector<SumAxis>& axes);

  std::int64_t size() const { return size_; }
  /// The point with `rank` points before it, 0 <= rank < size().
  RankedPoint find(std::int64_t rank) const;
  /// The number of points that have a sum of at most `sum`.
  std::int64_t count_up_to(std::int64_t sum) const;

 private:
  std::int64_t find_tie(std::int64_t sum, std::int64_t rank) const;

  std::vector<std::int64_t> high_;         // sum of each point of the first axes, by id
  std::vector<std::int64_t> sorted_high_;  // the same, ascending
  std::vector<std::int64_t> sorted_low_;   // sums of the points of the last axes, ascending
  std::vector<std::int64_t> low_id_;       // ids in the order of sorted_low_; equal sums by id
  std::int64_t size_ = 1;
};

}  // namespace strut
