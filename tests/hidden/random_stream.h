// A sequence of random numbers for one purpose of one trial.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>

#include "base/math/random.h"

namespace strut::hidden {

/// 64-bit FNV-1a hash of a text: one stream per purpose.
constexpr std::uint64_t calc_stream(const char* purpose) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (; *purpose != '\0'; ++purpose) {
    hash = (hash ^ static_cast<unsigned char>(*purpose)) * 1099511628211ULL;
  }
  return hash;
}

/// Draws of a trial for one purpose. Each purpose has its own sequence, so that draws of one part
/// do not affect the others.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, const std::string& purpose)
      : seed_(seed), stream_(calc_stream(purpose.c_str())) {}

  /// Uniform on [low, high).
  double draw_uniform(double low = 0.0, double high = 1.0) {
    return low + (high - low) * calc_uniform(seed_, stream_, counter_++);
  }
  /// Log-uniform on [low, high), both > 0.
  double draw_log_uniform(double low, double high) {
    return low * std::exp(draw_uniform() * std::log(high / low));
  }
  /// Standard normal by Box and Muller's formula, one of the pair.
  double draw_normal() {
    const double radius = std::sqrt(-2.0 * std::log1p(-draw_uniform()));
    return radius * std::cos(draw_uniform(0.0, 2.0 * 3.14159265358979323846));
  }
  /// Whole number in [0, count).
  int draw_index(int count) { return static_cast<int>(draw_uniform() * count); }
  double draw_sign() { return draw_uniform() < 0.5 ? -1.0 : 1.0; }

 private:
  std::uint64_t seed_, stream_, counter_ = 0;
};

}  // namespace strut::hidden
