// Strata, "layers": which one a level belongs to, how many cases each gives, which ones those are.
// The planner of a sweep and the sampler of a training share these rules.
//
// Hierarchical sampling with fixed proportion: W. G. Cochran, Sampling Techniques, 3rd ed., ch. 5;
// whole numbers by the largest remainder (Hamilton).
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

/// Layer of level `level` of `levels`: floor(level * layers / levels).
int find_layer(std::int64_t level, std::int64_t levels, int layers);

/// The first level in layer `layer`; find_first_level(layers, ...) == levels.
std::int64_t find_first_level(int layer, std::int64_t levels, int layers);

/// The share of `count` that each layer gives: proportional to its population, whole numbers by the
/// largest remainder, ties to the lower index. None gives more than it has. Throws
/// std::invalid_argument where `count` is negative or more than all have.
std::vector<std::int64_t> allocate_proportionally(std::int64_t count,
                                                  std::span<const std::int64_t> populations);

/// Exact stratified sample without replacement: walks a random order of 0 .. n - 1 and takes each
/// number whose layer `layer_of(number)` has some of its quota left. Sorted. The quotas may not
/// exceed the layers' populations. Every sample that fits the quotas is equally likely.
template <class LayerOf>
std::vector<std::int64_t> draw_stratified(std::vector<std::int64_t> quotas,
                                          const Permutation& order, const LayerOf& layer_of) {
  std::int64_t left = 0;
  for (const std::int64_t quota : quotas) left += quota;
  std::vector<std::int64_t> drawn;
  drawn.reserve(static_cast<std::size_t>(left));
  for (std::int64_t i = 0; left > 0 && i < order.size(); ++i) {
    const std::int64_t number = order.apply(i);
    std::int64_t& quota = quotas[static_cast<std::size_t>(layer_of(number))];
    if (quota == 0) continue;
    --quota;
    --left;
    drawn.push_back(number);
  }
  std::sort(drawn.begin(), drawn.end());
  return drawn;
}

}  // namespace strut
