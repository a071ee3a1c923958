#include "model/scenario/road_density.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace strut {

double calc_height_density(double wave_number) { return 0.5 * 0.01 / (wave_number * wave_number); }

double calc_track_coherence(double wave_number, double width) {
  constexpr double kTrusted = 0.9;
  const double x = 2.0 * std::numbers::pi * wave_number * width;
  return x < 1e-6 ? kTrusted : kTrusted * x * std::cyl_bessel_k(1.0, std::min(x, 50.0));
}

}  // namespace strut
