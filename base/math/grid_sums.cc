#include "base/math/grid_sums.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <span>
#include <stdexcept>

namespace strut {
namespace {

std::int64_t multiply(const std::vector<SumAxis>& axes, std::size_t begin, std::size_t end) {
  std::int64_t product = 1;
  for (std::size_t a = begin; a < end; ++a) product *= axes[a].count;
  return product;
}

/// Number of axes in the first half; minimizes the size of the larger half.
std::size_t find_cut(const std::vector<SumAxis>& axes) {
  std::size_t best = 0;
  std::int64_t smallest = std::numeric_limits<std::int64_t>::max();
  for (std::size_t cut = 0; cut <= axes.size(); ++cut) {
    const std::int64_t larger = std::max(multiply(axes, 0, cut), multiply(axes, cut, axes.size()));
    if (larger < smallest) smallest = larger, best = cut;
  }
  return best;
}

/// Sum of each point of axes [begin, end), by id.
std::vector<std::int64_t> list_sums(const std::vector<SumAxis>& axes, std::size_t begin,
                                    std::size_t end) {
  std::vector<std::int64_t> sums = {0};
  for (std::size_t a = begin; a < end; ++a) {
    std::vector<std::int64_t> longer;
    longer.reserve(sums.size() * static_cast<std::size_t>(axes[a].count));
    for (const std::int64_t sum : sums) {
      for (std::int64_t i = 0; i < axes[a].count; ++i) longer.push_back(sum + i * axes[a].weight);
    }
    sums = std::move(longer);
  }
  return sums;
}

/// Number of pairs whose sum is at most `sum`; both lists are ascending. As the value from `few`
/// grows, the end of the matching values of `many` moves backwards: step by step, or by bisection
/// where `many` is much longer.
std::int64_t count_pairs(std::span<const std::int64_t> few, std::span<const std::int64_t> many,
                         std::int64_t sum) {
  constexpr std::size_t kBisectionRatio = 32;
  const bool bisect = many.size() > kBisectionRatio * few.size();
  std::int64_t count = 0;
  auto end = many.end();
  for (const std::int64_t value : few) {
    if (bisect) {
      end = std::upper_bound(many.begin(), end, sum - value);
    } else {
      while (end != many.begin() && *(end - 1) > sum - value) --end;
    }
    if (end == many.begin()) break;
    count += end - many.begin();
  }
  return count;
}

}  // namespace

GridSums::GridSums(const std::vector<SumAxis>& axes) : size_(multiply(axes, 0, axes.size())) {
  const std::size_t cut = find_cut(axes);
  const std::int64_t larger = std::max(multiply(axes, 0, cut), multiply(axes, cut, axes.size()));
  if (larger > kMaxHalf) {
    throw std::invalid_argument(fmt::format(
        "the axes split into halves of up to {} points; allowed: at most {}", larger, kMaxHalf));
  }
  high_ = list_sums(axes, 0, cut);
  sorted_high_ = high_;
  std::sort(sorted_high_.begin(), sorted_high_.end());
  const std::vector<std::int64_t> low = list_sums(axes, cut, axes.size());
  low_id_.resize(low.size());
  std::iota(low_id_.begin(), low_id_.end(), std::int64_t{0});
  const auto sum_of = [&low](std::int64_t id) { return low[static_cast<std::size_t>(id)]; };
  std::stable_sort(low_id_.begin(), low_id_.end(),
                   [&](std::int64_t a, std::int64_t b) { return sum_of(a) < sum_of(b); });
  sorted_low_.reserve(low.size());
  for (const std::int64_t id : low_id_) sorted_low_.push_back(sum_of(id));
}

std::int64_t GridSums::count_up_to(std::int64_t sum) const {
  return sorted_high_.size() < sorted_low_.size() ? count_pairs(sorted_high_, sorted_low_, sum)
                                                  : count_pairs(sorted_low_, sorted_high_, sum);
}

RankedPoint GridSums::find(std::int64_t rank) const {
  std::int64_t below = -1;  // count_up_to(below) <= rank < count_up_to(sum)
  std::int64_t sum = sorted_high_.back() + sorted_low_.back();
  while (sum - below > 1) {
    const std::int64_t middle = below + (sum - below) / 2;
    (count_up_to(middle) > rank ? sum : below) = middle;
  }
  return {sum, find_tie(sum, rank - count_up_to(below))};
}

/// Id of the point that has `rank` points of the same sum before it.
std::int64_t GridSums::find_tie(std::int64_t sum, std::int64_t rank) const {
  std::int64_t first = 0;  // id of the first point with this high part
  for (const std::int64_t high : high_) {
    const auto [begin, end] = std::equal_range(sorted_low_.begin(), sorted_low_.end(), sum - high);
    if (rank < end - begin) {
      return first + low_id_[static_cast<std::size_t>(begin - sorted_low_.begin() + rank)];
    }
    rank -= end - begin;
    first += static_cast<std::int64_t>(sorted_low_.size());
  }
  return -1;
}

}  // namespace strut
