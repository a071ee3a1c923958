// A strut's force as a tensor product of uniform cubic B-splines over deflection and velocity.
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "model/force/strut.h"

namespace strut {

/// A range divided into cells of equal width.
template <class T>
struct SplineAxis {
  T low;    // in the argument's unit
  T scale;  // cells per unit
  T cells;  // their number
  bool operator==(const SplineAxis&) const = default;
};

/// The four splines that are not zero at an argument: index of the first and values of all.
template <class T>
struct SplinePoint {
  T first;
  std::array<T, 4> weight;
};

/// Clamps the argument to the range. NaN selects the first cell, because the result is an index.
template <class T>
SplinePoint<T> calc_spline_point(const SplineAxis<T>& axis, const T& argument) {
  T u = (argument - axis.low) * axis.scale;
  u = select(u > T(0.0), u, T(0.0));
  u = select(u < axis.cells, u, axis.cells);
  const T cell = min(floor(u), axis.cells - T(1.0));
  const T t = u - cell, s = T(1.0) - t;
  const T t2 = t * t, s2 = s * s;
  const T sixth(1.0 / 6.0), rest(2.0 / 3.0), half(0.5);
  return {cell,
          {sixth * s2 * s, rest - t2 + half * t2 * t, rest - s2 + half * s2 * s, sixth * t2 * t}};
}

/// A map of at least one cell per variable; it is constant in a variable on which it does not
/// depend.
struct ForceMapTable {
  SplineAxis<double> deflection, velocity;
  double stride;                     // coefficients per row, which has one deflection
  std::vector<double> coefficients;  // N
  bool operator==(const ForceMapTable&) const = default;
};

/// Zero everywhere.
inline ForceMapTable make_flat_force_map() {
  return {{0.0, 1.0, 1.0}, {0.0, 1.0, 1.0}, 4.0, std::vector<double>(16, 0.0)};
}

/// F(d, v), d = nominal length - length and v = -d(length)/dt.
template <class T>
struct MappedForce {
  static constexpr Line kLine = kDamperLine;
  static constexpr bool kConservative = false;
  T nominal_length;  // m
  SplineAxis<T> deflection, velocity;
  T first, stride;                // index of the first coefficient in `table`, coefficients per row
  const double* table = nullptr;  // coefficients of all maps of all lanes

  T calc_force(const LineState<T>& line) const {
    const SplinePoint<T> d = calc_spline_point(deflection, nominal_length - line.length);
    const SplinePoint<T> v = calc_spline_point(velocity, -line.rate);
    T row = first + d.first * stride + v.first, force(0.0);
    for (std::size_t i = 0; i < 4; ++i) {
      T sum(0.0);
      for (std::size_t j = 0; j < 4; ++j) sum += v.weight[j] * gather(table + j, row);
      force += d.weight[i] * sum;
      row += stride;
    }
    return force;
  }
  T calc_energy(const LineState<T>&) const { return T(0.0); }
};

/// Concatenates the tables of several lanes.
class ForceMapPacker {
 public:
  /// The force of one strut in W lanes by their tables; zero in lanes without one (null). The
  /// caller sets its `table` to the coefficients that `finish` returns.
  template <class T>
  MappedForce<T> add(const ForceMapTable* const* lanes, const T& nominal_length) {
    MappedForce<T> force{};
    force.nominal_length = nominal_length;
    const ForceMapTable flat = make_flat_force_map();
    for (int lane = 0; lane < kLaneCount<T>; ++lane) {
      const ForceMapTable& map = lanes[lane] != nullptr ? *lanes[lane] : flat;
      set_axis(force.deflection, map.deflection, lane);
      set_axis(force.velocity, map.velocity, lane);
      set_lane(force.stride, lane, map.stride);
      set_lane(force.first, lane, append(lanes[lane], map));
    }
    return force;
  }

  std::shared_ptr<const std::vector<double>> finish() {
    return std::make_shared<const std::vector<double>>(std::move(coefficients_));
  }

 private:
  template <class T>
  static void set_axis(SplineAxis<T>& axis, const SplineAxis<double>& of, int lane) {
    set_lane(axis.low, lane, of.low);
    set_lane(axis.scale, lane, of.scale);
    set_lane(axis.cells, lane, of.cells);
  }
  /// Index of the map's first coefficient; each map is appended once.
  double append(const ForceMapTable* key, const ForceMapTable& map) {
    for (const auto& [known, first] : placed_) {
      if (known == key) return first;
    }
    const auto first = static_cast<double>(coefficients_.size());
    coefficients_.insert(coefficients_.end(), map.coefficients.begin(), map.coefficients.end());
    placed_.emplace_back(key, first);
    return first;
  }

  std::vector<double> coefficients_;
  std::vector<std::pair<const ForceMapTable*, double>> placed_;
};

}  // namespace strut
