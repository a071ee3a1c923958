// Roughness of the road under one track of wheels, beside its bump: heights as the tires follow
// them.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "base/math/lanes.h"

namespace strut {

/// Height z(x) = sum_i c_i B((x - begin) / spacing - i), B: cubic B-spline over [0, 4]; zero
/// outside of [begin, begin + spacing (count + 3)], where all of its first two derivatives are
/// continuous. x runs forward from the bump's center.
struct RoughTrack {
  double begin = 0.0, spacing = 1.0;  // m
  std::vector<double> coefficients;   // m; empty: smooth
  bool operator==(const RoughTrack&) const = default;
};

/// The rough tracks of the lanes.
template <class T>
struct RoughTracks {
  bool is_rough = false;  // in any lane
  /// Coefficients of all distinct tracks, one after the other, each between three zeros.
  std::vector<double> coefficients;
  T begin = T(0.0), inverse_spacing = T(1.0);  // m, 1/m
  T first = T(0.0), cells = T(0.0);            // offset in `coefficients`, number of cells
};

/// Height [m] and slope at x [m] from the bump's center.
template <class T>
void add_roughness(const RoughTracks<T>& tracks, const T& x, T& height, T& slope) {
  const T place = (x - tracks.begin) * tracks.inverse_spacing;
  const auto inside = (place > T(0.0)) & (place < tracks.cells);
  if (!any(inside)) return;
  const T cell = floor(select(inside, place, T(0.0)));
  const T t = select(inside, place, T(0.0)) - cell, u = T(1.0) - t;
  const double* table = tracks.coefficients.data();
  const T at = tracks.first + cell;
  const T a = gather(table, at), b = gather(table + 1, at);
  const T c = gather(table + 2, at), d = gather(table + 3, at);
  constexpr double kSixth = 1.0 / 6.0;
  const T of_b = T(4.0) - T(6.0) * t * t + T(3.0) * t * t * t;
  const T of_c = T(4.0) - T(6.0) * u * u + T(3.0) * u * u * u;
  const T z = T(kSixth) * (u * u * u * a + of_b * b + of_c * c + t * t * t * d);
  const T z_t = T(0.5) * (t * t * d - u * u * a + t * (T(3.0) * t - T(4.0)) * b -
                          u * (T(3.0) * u - T(4.0)) * c);
  height += select(inside, z, T(0.0));
  slope += select(inside, tracks.inverse_spacing * z_t, T(0.0));
}

/// Appends the coefficients of a track between three zeros, four zeros if it has none.
inline void add_padded(const std::vector<double>& coefficients, std::vector<double>& list) {
  list.insert(list.end(), coefficients.empty() ? 1 : 3, 0.0);
  list.insert(list.end(), coefficients.begin(), coefficients.end());
  list.insert(list.end(), 3, 0.0);
}

/// Lanes with the same coefficients share them.
template <class T>
RoughTracks<T> make_rough_tracks(const RoughTrack* const tracks[]) {
  RoughTracks<T> out;
  std::array<std::size_t, kLaneCount<T>> first;
  for (std::size_t lane = 0; lane < first.size(); ++lane) {
    const RoughTrack& track = *tracks[lane];
    std::size_t equal = 0;  // the first lane with these coefficients
    while (tracks[equal]->coefficients != track.coefficients) ++equal;
    first[lane] = equal < lane ? first[equal] : out.coefficients.size();
    set_lane(out.first, static_cast<int>(lane), static_cast<double>(first[lane]));
    if (equal == lane) add_padded(track.coefficients, out.coefficients);
    if (track.coefficients.empty()) continue;
    out.is_rough = true;
    set_lane(out.begin, static_cast<int>(lane), track.begin);
    set_lane(out.inverse_spacing, static_cast<int>(lane), 1.0 / track.spacing);
    set_lane(out.cells, static_cast<int>(lane), static_cast<double>(track.coefficients.size() + 3));
  }
  return out;
}

}  // namespace strut
