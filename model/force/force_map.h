// A strut's force as a tensor product of uniform cubic B-splines over deflection and velocity.
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "model/force/strut.h"

namespace strut {

/// A range cut into cells of equal width.
template <class T>
struct SplineAxis {
  T low;    // of the argument's unit
  T scale;  // cells over width, 1 / unit
  T cells;
};

/// The four splines that are not zero at an argument: the first of them and their values.
template <class T>
struct SplinePoint {
  T first;
  std::array<T, 4> weight;
};

/// Outside of the range as at its end. An argument that is no number falls into the first cell:
/// what comes of it is an index.
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

/// A map of at least one cell by one: a variable that it does not depend on is one of constants.
struct ForceMapTable {
  SplineAxis<double> deflection, velocity;
  double stride;                     // coefficients a row of one deflection
  std::vector<double> coefficients;  // N
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
  T first, stride;                // of the coefficients in `table`
  const double* table = nullptr;  // of all maps of all lanes

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

/// The tables of several lanes behind each other.
class ForceMapPacker {
 public:
  /// The force of one strut in W lanes by their tables; zero in those that have none (null). Its
  /// table is not set before `finish`.
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
  /// Where the coefficients begin; a map that is there already is not put there twice.
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
