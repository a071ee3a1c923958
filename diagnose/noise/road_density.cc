#include "diagnose/noise/road_density.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace strut {

double calc_slope_density(double /*wave_number*/) {
  constexpr double kReference = 0.1;  // 1/m
  return 2.0 * std::numbers::pi * std::numbers::pi * kReference * kReference;
}

double calc_track_coherence(double wave_number, double width) {
  constexpr double kTrusted = 0.9;
  const double x = 2.0 * std::numbers::pi * wave_number * width;
  return x < 1e-6 ? kTrusted : kTrusted * x * std::cyl_bessel_k(1.0, std::min(x, 50.0));
}

}  // namespace strut
