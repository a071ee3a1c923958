// The tire and road functions the full-coordinate car borrows; everything else is its own.
#pragma once

#include <functional>
#include <vector>

#include "model/car/spec.h"
#include "model/force/pac2002.h"
#include "model/scenario/maneuver.h"
#include "model/scenario/road.h"

namespace strut::reference {

struct ReferenceLaws {
  /// In-plane force of a corner's tire (left or right) in contact axes.
  std::function<TireForce<double>(int corner, const TireSlip<double>&)> tire_force;
  /// Effective rolling radius [m] at a deflection [m].
  std::function<double(double deflection)> rolling_radius;
  /// Effective road plane of a corner at the world x of its wheel center.
  std::function<RoadPoint<double>(int corner, double x)> ground;
  /// World x where `ground` of a corner is not smooth; an integrator restarts there.
  std::function<std::vector<double>(int corner)> kinks;
};

/// Flat road, and the PAC2002 functions of the vehicle's tire, mirrored on the right.
ReferenceLaws make_flat_road_laws(const VehicleSpec& spec);

/// The same on the maneuver's road with its bump centered at world x = `bump_center` [m].
ReferenceLaws make_bump_laws(const VehicleSpec& spec, const ManeuverSpec& maneuver,
                             double bump_center);

}  // namespace strut::reference
