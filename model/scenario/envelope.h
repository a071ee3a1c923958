// The contact height of a tire: that of a disc rolled over the profile, or the profile itself, as a
// sequence of smooth branches that meet where slope or curvature may jump.
#pragma once

#include <functional>
#include <vector>

#include "model/scenario/profile.h"

namespace strut {

/// Smooth stretch of the contact height between begin and end, x [m] from the bump's center. Its
/// function refers to the profile, which must outlive it.
struct Branch {
  double begin = 0.0, end = 0.0;
  std::function<Jet(double x)> calc;
};

/// Height of the center of a disc of this radius [m] over the profile, less the radius:
/// max over s of z(x + s) + sqrt(R^2 - s^2) - R. Consecutive branches, without the flat road on
/// both sides; empty for a flat road.
std::vector<Branch> make_disc_envelope(const Profile& profile, double radius);

/// The profile itself, one branch per piece.
std::vector<Branch> make_point_branches(const Profile& profile);

}  // namespace strut
