// Specification of a maneuver: speed, drive torque, road. Plain data in SI units.
#pragma once

#include <array>

#include "model/scenario/road.h"
#include "model/scenario/road_profile.h"
#include "model/scenario/rough_track.h"

namespace strut {

enum class TrimKind {
  kSteady,  // the car starts in the steady state with the torque on: only the bump excites it
  kStatic,  // the car starts in the steady state without torque, which is switched on at t = 0
};

struct ManeuverSpec {
  double speed = 20.0;          // m/s, initial forward speed
  double duration = 3.0;        // s
  double drive_torque = 500.0;  // N m, sum over the wheels
  double drive_reaction = 1.0;  // fraction of it that the chassis reacts; 0: it comes from outside
  double bump_distance = 10.0;  // m, bump center ahead of the front wheel centers at t = 0
  double lead_time = 0.0;       // s, the car starts this much earlier than bump_distance says
  double lead_speed = 0.0;      // m/s, and this much faster
  TrimKind trim = TrimKind::kSteady;
  double gravity = 9.81;  // m/s^2
  RoadSpec road;
  SharedProfile profile;            // roughness by height; the tires' contact follows it
  std::array<RoughTrack, 2> rough;  // left, right: roughness as tires follow it; needs no profile
  bool operator==(const ManeuverSpec&) const = default;
};

/// The way of the car in its lead time [m].
inline double calc_lead(const ManeuverSpec& maneuver) {
  return maneuver.lead_time * (maneuver.speed + 0.5 * maneuver.lead_speed);
}

}  // namespace strut
