// Roughness of a road by its height under both tracks of wheels: surveyed, or drawn by class.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "model/scenario/road.h"
#include "model/scenario/rough_track.h"

namespace strut {

inline constexpr std::size_t kMaxRoadPoints = 200'000;  // of a track
inline constexpr double kMaxRoadHeight = 2.0;           // m
inline constexpr double kMaxRoadBegin = 10'000.0;       // m

/// Heights at equally spaced points; the road is flat, at height 0, before the first and behind the
/// last.
struct RoadProfile {
  double begin = 0.0;     // m ahead of the front wheel centers at the start, >= 0
  double spacing = 0.02;  // m, (0, 0.5]
  std::array<std::vector<double>, 2> height;  // m; left, right: equally many
  bool operator==(const RoadProfile&) const = default;
};

/// A profile that many maneuvers share; null: none. Compared by its numbers.
struct SharedProfile {
  std::shared_ptr<const RoadProfile> data;
  bool operator==(const SharedProfile& other) const {
    return data == other.data || (data && other.data && *data == *other.data);
  }
};

/// Throws ModelError with field, value and allowed range.
void validate(const RoadProfile& profile);

/// Fades both tracks in and out over `length` [m] at either end, by a half cosine.
void fade_ends(RoadProfile& profile, double length);

/// Both tracks as a tire follows them: the height of a disc of the free tire radius that rolls over
/// the profile, averaged over the footprint with the cubic B-spline kernel (road.h); kPoint: the
/// profile itself, rounded over half a point's spacing. Between the points the road is straight. A
/// track begins `bump_distance` [m] before its place ahead of the front wheels, as RoughTrack
/// counts from the bump's center. Throws as both `validate` do.
std::array<RoughTrack, 2> follow_profile(const RoadProfile& profile, const ContactGeometry& contact,
                                         double bump_distance);

}  // namespace strut
