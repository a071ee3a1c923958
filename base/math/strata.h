// Stratified sampling: the stratum of a level, the allocation of a sample to strata, and the
// sample. The planner of a sweep and the sampler of a training share these rules.
//
// Proportional allocation: W. G. Cochran, Sampling Techniques, 3rd ed., ch. 5; whole numbers by the
// largest remainder (Hamilton).
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "base/math/permutation.h"

namespace strut {

/// floor(value * factor / divisor) of integers whose product may exceed 64 bits; factor <= divisor,
/// all >= 0.
std::int64_t scale_down(std::int64_t value, std::int64_t factor, std::int64_t divisor);

/// Stratum of level `level` of `levels`: floor(level * strata / levels).
int find_stratum(std::int64_t level, std::int64_t levels, int strata);

/// The first level in stratum `stratum`; find_first_level(strata, ...) == levels.
std::int64_t find_first_level(int stratum, std::int64_t levels, int strata);

/// Allocates a sample of `count` to strata in proportion to their populations, in whole numbers by
/// the largest remainder, ties to the lower index. No allocation exceeds its population. Throws
/// std::invalid_argument where `count` is negative or exceeds the total population.
std::vector<std::int64_t> allocate_proportionally(std::int64_t count,
                                                  std::span<const std::int64_t> populations);

/// Draws an exact stratified sample without replacement: walks a random order of 0 .. n - 1 and
/// takes each number until the quota of its stratum, `stratum_of(number)`, is exhausted. Returns
/// the numbers sorted. No quota may exceed the population of its stratum. Every sample that meets
/// the quotas is equally likely.
template <class StratumOf>
std::vector<std::int64_t> draw_stratified(std::vector<std::int64_t> quotas,
                                          const Permutation& order, const StratumOf& stratum_of) {
  std::int64_t remaining = 0;
  for (const std::int64_t quota : quotas) remaining += quota;
  std::vector<std::int64_t> drawn;
  drawn.reserve(static_cast<std::size_t>(remaining));
  for (std::int64_t i = 0; remaining > 0 && i < order.size(); ++i) {
    const std::int64_t number = order.apply(i);
    std::int64_t& quota = quotas[static_cast<std::size_t>(stratum_of(number))];
    if (quota == 0) continue;
    --quota;
    --remaining;
    drawn.push_back(number);
  }
  std::sort(drawn.begin(), drawn.end());
  return drawn;
}

}  // namespace strut
