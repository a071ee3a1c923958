#include "model/scenario/iso_road.h"

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <unsupported/Eigen/FFT>
#include <vector>

#include "base/math/random.h"
#include "model/scenario/road_density.h"
#include "model/scenario/road_fault.h"

namespace strut {
namespace {

constexpr double kLowest = 0.011, kHighest = 2.83;  // 1/m, of ISO 8608
constexpr double kSpacing = 0.01;                   // m, 35 points a wave at least
constexpr double kFade = 5.0;                       // m

/// The first number of points from `least` on without a prime factor above 5: others take a Fourier
/// transform up to their square.
std::size_t find_fast_count(double least) {
  for (auto count = static_cast<std::size_t>(std::ceil(least));; ++count) {
    std::size_t rest = count;
    for (const std::size_t factor : {2, 3, 5}) {
      while (rest % factor == 0) rest /= factor;
    }
    if (rest == 1) return count;
  }
}

}  // namespace

RoadProfile make_iso_road(const IsoRoad& road) {
  require_road_range("road.roughness", road.roughness, 0.0, 1.0, "m^3");
  require_road_range("road.length", road.length, 20.0, 2000.0);
  require_road_range("road.track_width", road.track_width, 0.1, 5.0);
  const std::size_t count = find_fast_count(road.length / kSpacing);
  RoadProfile profile{road.begin, road.length / static_cast<double>(count), {}};
  std::array<std::vector<std::complex<double>>, 2> waves;  // of each track, by k
  for (auto& track : waves) track.assign(count, 0.0);
  for (std::size_t k = 1; static_cast<double>(k) <= kHighest * road.length; ++k) {
    const double n = static_cast<double>(k) / road.length;
    if (n < kLowest) continue;
    // A wave of amplitude a has the mean square a^2 / 2, the integral of the two-sided density over
    // 1 / length at n and at -n.
    const double amplitude = std::sqrt(4.0 * road.roughness * calc_height_density(n) / road.length);
    const double coherence = calc_track_coherence(n, road.track_width);
    const auto turn = [&](std::uint64_t stream) {
      return std::polar(1.0, 2.0 * std::numbers::pi * calc_uniform(road.seed, stream, k));
    };
    const std::complex<double> common = turn(0), own = turn(1);
    waves[0][k] = amplitude * common;
    waves[1][k] = amplitude * (coherence * common + std::sqrt(1.0 - coherence * coherence) * own);
  }
  Eigen::FFT<double> transform;
  for (std::size_t side = 0; side < 2; ++side) {
    // Its inverse divides by the number of points.
    std::vector<std::complex<double>> heights;
    transform.inv(heights, waves[side]);
    for (const std::complex<double>& height : heights) {
      profile.height[side].push_back(static_cast<double>(count) * height.real());
    }
  }
  fade_ends(profile, kFade);
  validate(profile);
  return profile;
}

}  // namespace strut
