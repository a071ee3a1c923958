// One variable of a force map and its splines, as columns of a regression.
#pragma once

#include <Eigen/Core>

#include "base/math/eigen_abi.h"
#include "model/effects/force_map.h"
#include "model/force/force_map.h"

namespace strut {

struct MapAxis {
  double low = -1.0, high = 1.0;
  int count = 1;

  /// B_i(x), i from 0 to count - 1; 1 for a count of 1. x is clamped to the range.
  Eigen::VectorXd calc_splines(double x) const {
    if (count == 1) return Eigen::VectorXd::Ones(1);
    const double cells = count - 3;
    const SplinePoint<double> point =
        calc_spline_point(SplineAxis<double>{low, cells / (high - low), cells}, x);
    Eigen::VectorXd splines = Eigen::VectorXd::Zero(count);
    for (int i = 0; i < 4; ++i) {
      splines(static_cast<Eigen::Index>(point.first) + i) =
          point.weight[static_cast<std::size_t>(i)];
    }
    return splines;
  }
};

inline MapAxis get_deflection_axis(const ForceMap& map) {
  return {map.deflection_low, map.deflection_high, map.deflection_count};
}

inline MapAxis get_velocity_axis(const ForceMap& map) {
  return {map.velocity_low, map.velocity_high, map.velocity_count};
}

}  // namespace strut
