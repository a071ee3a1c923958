#include "base/math/grid_sums.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <span>
#include <stdexcept>
#include <string>

namespace strut {
namespace {

std::int64_t multiply(const std::vector<SumAxis>& axes, std::size_t begin, std::size_t end) {
  std::int64_t product = 1;
  for (std::size_t a = begin; a < end; ++a) product *= axes[a].count;
  return product;
}

/// Where to cut so that the larger half is smallest.
std::size_t find_cut(const std::vector<SumAxis>& axes) {
  std::size_t best = 0;
  std::int64_t least = std::numeric_limits<std::int64_t>::max();
  for (std::size_t cut = 0; cut <= axes.size(); ++cut) {
    const std::int64_t larger = std::max(multiply(axes, 0, cut), multiply(axes, cut, axes.size()));
    if (larger < least) least = larger, best = cut;
  }
  return best;
}

/// Sum of each point of axes [begin, end), by number.
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

/// Pairs whose sum is at most `sum`. While one half's share grows, the place in the other only
/// moves back; of halves that differ much, every place is searched for.
std::int64_t count_pairs(std::span<const std::int64_t> few, std::span<const std::int64_t> many,
                         std::int64_t sum) {
  constexpr std::size_t kMuchMore = 32;
  const bool search = many.size() > kMuchMore * few.size();
  std::int64_t count = 0;
  auto end = many.end();
  for (const std::int64_t share : few) {
    if (search) {
      end = std::upper_bound(many.begin(), end, sum - share);
    } else {
      while (end != many.begin() && *(end - 1) > sum - share) --end;
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
  if (larger > kLargestHalf) {
    throw std::invalid_argument("the axes cannot be halved to at most " +
                                std::to_string(kLargestHalf) + " points each, only to " +
                                std::to_string(larger));
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

/// Number of the point that is `place`-th among those of this sum.
std::int64_t GridSums::find_tie(std::int64_t sum, std::int64_t place) const {
  std::int64_t first = 0;  // number of the first point of this high part
  for (const std::int64_t high : high_) {
    const auto [begin, end] = std::equal_range(sorted_low_.begin(), sorted_low_.end(), sum - high);
    if (place < end - begin) {
      return first + low_id_[static_cast<std::size_t>(begin - sorted_low_.begin() + place)];
    }
    place -= end - begin;
    first += static_cast<std::int64_t>(sorted_low_.size());
  }
  return -1;
}

}  // namespace strut
