// One corner from its specification: joints, loops, bodies, rods, mounts and the preparation of its
// closure.
#pragma once

#include "model/car/spec.h"
#include "model/multibody/closure.h"

namespace strut {

/// Maximum |q| up to which every corner must close [m]; tables and predictors are fitted over it.
inline constexpr double kHalfTravel = 0.10;

/// One corner at nominal trim, with the elimination order and the predictor of its closure.
struct BuiltCorner {
  CornerTopology topology;
  CornerGeometry<double> geometry{};
  CornerInertia<double> inertia{};
  ClosurePredictor<double> predictor;
};

/// Key of an axle's table in a vehicle file, for messages.
const char* get_axle_key(int axle);

/// Spin axis of a wheel, a unit vector to the left; toe-in and camber have opposite signs left and
/// right.
Vec3<double> calc_spin_axis(const SuspensionSpec& spec, bool right);

/// Builds a corner with its axle reference at `reference` [m, chassis axes] and the chassis end of
/// the tie rod displaced by `rack` [m]. Throws ModelError for a wrong number of rods, a mount on a
/// missing part, loops that are singular or do not close over +/-kHalfTravel.
BuiltCorner build_corner(const VehicleSpec& spec, int corner, const Vec3<double>& reference,
                         double rack);

}  // namespace strut
