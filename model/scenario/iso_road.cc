#include "model/scenario/iso_road.h"

#include <fmt/format.h>

#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

#include "base/math/random.h"
#include "model/error/model_error.h"
#include "model/scenario/road_density.h"

namespace strut {
namespace {

constexpr double kLowest = 0.011, kHighest = 2.83;  // 1/m, of ISO 8608
constexpr double kSpacing = 0.01;                   // m, 35 points a wave at least
constexpr double kFade = 5.0;                       // m

void require(const std::string& field, double value, double min, double max,
             const std::string& unit) {
  if (value >= min && value <= max) return;
  throw ModelError(fmt::format("{} = {:g} is not allowed: must lie in [{:g}, {:g}] {}", field,
                               value, min, max, unit),
                   ModelFault::kRoad);
}

/// Adds amplitude cos(2 pi k i / count + phase) by rotation.
void add_wave(double amplitude, double phase, std::size_t k, std::size_t count,
              std::vector<double>& heights) {
  const double angle = 2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(count);
  const std::complex<double> turn = std::polar(1.0, angle);
  std::complex<double> wave = std::polar(amplitude, phase);
  for (double& height : heights) {
    height += wave.real();
    wave *= turn;
  }
}

}  // namespace

RoadProfile make_iso_road(const IsoRoad& road) {
  require("road.roughness", road.roughness, 0.0, 1.0, "m^3");
  require("road.length", road.length, 20.0, 2000.0, "m");
  require("road.track_width", road.track_width, 0.1, 5.0, "m");
  const auto count = static_cast<std::size_t>(std::ceil(road.length / kSpacing));
  RoadProfile profile{road.begin, road.length / static_cast<double>(count), {}};
  for (std::vector<double>& track : profile.height) track.assign(count, 0.0);
  for (std::size_t k = 1; static_cast<double>(k) <= kHighest * road.length; ++k) {
    const double n = static_cast<double>(k) / road.length;
    if (n < kLowest) continue;
    // A wave of amplitude a has the mean square a^2 / 2, the integral of the two-sided density over
    // 1 / length at n and at -n.
    const double amplitude = std::sqrt(4.0 * road.roughness * calc_height_density(n) / road.length);
    const double coherence = calc_track_coherence(n, road.track_width);
    const auto phase = [&](std::uint64_t stream) {
      return 2.0 * std::numbers::pi * calc_uniform(road.seed, stream, k);
    };
    const double common = phase(0);
    add_wave(amplitude, common, k, count, profile.height[0]);
    add_wave(amplitude * coherence, common, k, count, profile.height[1]);
    add_wave(amplitude * std::sqrt(1.0 - coherence * coherence), phase(1), k, count,
             profile.height[1]);
  }
  fade_ends(profile, kFade);
  validate(profile);
  return profile;
}

}  // namespace strut
