// From a vehicle and a maneuver as a person writes them to the numbers the equations read.
#pragma once

#include "model/car/build_corner.h"
#include "model/car/closures.h"
#include "model/car/spec.h"
#include "model/car/vehicle.h"
#include "model/error/model_error.h"
#include "model/scenario/maneuver.h"

namespace strut {

/// One car in one maneuver, scalar.
struct AssembledVehicle {
  VehicleLayout layout;
  VehicleParameters<double> numbers;
  std::array<double, kCorners> nominal_load;  // N, at rest
  std::array<double, kCorners> preload;       // N, spring force at nominal trim
  double center_height = 0.0;                 // m, chassis origin over the ground at nominal trim
};

/// Returns the load on one tire of an axle at rest [N].
double calc_nominal_load(const VehicleSpec& spec, double gravity, int axle);

/// Returns the wheel center at nominal trim relative to the whole car's centroid [m], projected on
/// the car's plane of symmetry (y = 0). A cambered wheel stands lower by the cosine of its camber.
Vec3<double> calc_wheel_reference(const VehicleSpec& spec, double gravity, int corner);

/// Throws ModelError when no such car can stand: chassis mass or inertia not positive, loops that
/// do not close over +-kHalfTravel.
AssembledVehicle assemble_vehicle(const VehicleSpec& spec, const ManeuverSpec& maneuver);

/// Throws ModelError unless it is positive definite.
void check_chassis_inertia(const Sym3<double>& inertia);

/// Springs and dampers of `spec` over the preload of `car`; drive torque of `maneuver`.
void set_operating_parameters(const VehicleSpec& spec, const ManeuverSpec& maneuver,
                              const AssembledVehicle& car, VehicleParameters<double>& numbers);

/// Corner tables of an assembled car; each group of functions gets the lowest degree that
/// resolves it to kTableTolerance. Throws ModelError if kTableTerms do not suffice.
VehicleTables<double> tabulate_corners(const AssembledVehicle& car);

/// The effective road under this car's wheels: tire radius and contact model shape it.
Surface make_surface(const VehicleSpec& spec, const ManeuverSpec& maneuver);

/// World x of the bump center: `bump_distance` ahead of the nominal front wheel centers when the
/// chassis origin starts at x = 0.
double calc_bump_center(const AssembledVehicle& car, const ManeuverSpec& maneuver);

/// Puts the spring, damper and effect elements of T numbers into their lists, and the force maps of
/// each lane.
template <class T>
void fill_strut_elements(Vehicle<T>& vehicle, const CornerForceMaps* const* maps = nullptr) {
  const VehicleLayout& layout = vehicle.layout;
  const VehicleParameters<T>& numbers = vehicle.numbers;
  vehicle.struts = {};
  vehicle.effects = {};
  for (int c = 0; c < kCorners; ++c) {
    const unsigned bits = layout.strut_effects[c];
    std::get<0>(vehicle.struts).add(c, numbers.spring[c]);
    if ((bits & kShapedDamper) == 0) std::get<1>(vehicle.struts).add(c, numbers.damper[c]);
    vehicle.effects.add(c, bits, numbers.effects[c]);
  }
  for (int axle = 0; axle < kAxles; ++axle) {
    if (!layout.has_anti_roll_bar[axle]) continue;
    vehicle.effects.add_bar(2 * axle, numbers.anti_roll_bar[axle]);
  }
  if (maps == nullptr) return;
  vehicle.effects.add_maps(maps,
                           [&](int c) { return numbers.nominal_length[c * kLines + kDamperLine]; });
}

}  // namespace strut
