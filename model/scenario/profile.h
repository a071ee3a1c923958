// The profile of the bump, without a tire, as smooth pieces with two derivatives.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "model/scenario/road.h"

namespace strut {

/// Function value with its first two derivatives.
struct Jet {
  double value = 0.0, slope = 0.0, curvature = 0.0;
};

/// z(x) of one bump as smooth pieces; piece i spans ends[i] .. ends[i + 1].
struct Profile {
  std::vector<double> ends;
  std::function<Jet(std::size_t piece, double x)> calc;
  std::size_t get_piece_count() const { return ends.empty() ? 0 : ends.size() - 1; }
};

/// Profile of a valid specification; without pieces for a flat road. A table becomes a natural
/// cubic spline. The profile does not refer to the specification.
Profile make_profile(const RoadSpec& spec);

}  // namespace strut
