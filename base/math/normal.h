// The normal distribution: random numbers and intervals.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include "base/math/random.h"

namespace strut {

/// Half width of the central 95 % interval of a normal distribution, in standard deviations.
inline constexpr double kNormal95 = 1.959963984540054;

/// Probability that a standard normal number is below `z`: erfc(-z / sqrt(2)) / 2.
inline double calc_normal_probability(double z) {
  return 0.5 * std::erfc(-z / std::numbers::sqrt2);
}

/// Two independent standard normal numbers, by the trigonometric form of G. E. P. Box, M. E. Muller
/// (1958).
inline std::pair<double, double> calc_normal_pair(std::uint64_t seed, std::uint64_t stream,
                                                  std::uint64_t counter) {
  const double u = calc_uniform(seed, stream, 2 * counter);
  const double angle = 2.0 * std::numbers::pi * calc_uniform(seed, stream, 2 * counter + 1);
  const double radius = std::sqrt(-2.0 * std::log1p(-u));
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

/// The first of calc_normal_pair.
inline double calc_normal(std::uint64_t seed, std::uint64_t stream, std::uint64_t counter) {
  return calc_normal_pair(seed, stream, counter).first;
}

}  // namespace strut
