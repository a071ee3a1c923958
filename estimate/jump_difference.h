// Differences of readings that jump.
#pragma once

#include <cmath>

namespace strut {

/// Returns the difference of a reading over a whole symmetric step, from its rises `before` and
/// `after` the base point, in standard deviations of its noise. Where a contact event passes the
/// reading within the step, one of the two has a jump: then twice the smaller one. Rounding error,
/// far below kJump, is no jump.
inline double calc_jump_free_difference(double before, double after) {
  constexpr double kJump = 1e-5, kBend = 0.5;
  const double slope = before + after, bend = std::abs(after - before);
  if (bend <= kJump + kBend * std::abs(slope)) return slope;
  return 2.0 * (std::abs(after) < std::abs(before) ? after : before);
}

}  // namespace strut
