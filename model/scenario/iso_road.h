// Random road by the roughness classes of ISO 8608.
#pragma once

#include <cstdint>

#include "model/scenario/road_profile.h"

namespace strut {

/// One-sided density of the height of either track, G(n) = roughness (n / n0)^-2 with n0 = 0.1 1/m,
/// in the standard's range of wave numbers, 0.011 to 2.83 1/m. The geometric means of classes A to
/// H are 16, 64, 256, ... 262144 x 1e-6 m^3: each four times the one before.
struct IsoRoad {
  double roughness = 256e-6;  // m^3, G(n0)
  double length = 200.0;      // m
  double begin = 1.0;         // m, ahead of the front wheel centers at the start
  double track_width = 1.5;   // m between the tracks
  std::uint64_t seed = 1;
};

/// Sums of waves of length / k, k = 1, 2, ..., with the density's amplitudes and random phases; the
/// tracks have the coherence of calc_track_coherence (road_density.h). Both ends are faded over 5
/// m. Equal numbers for equal arguments. Throws ModelError for a value out of range.
RoadProfile make_iso_road(const IsoRoad& road);

}  // namespace strut
