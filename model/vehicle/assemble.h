// From a vehicle and a maneuver as a person writes them to the numbers the equations read.
#pragma once

#include "model/multibody/closures.h"
#include "model/scenario/maneuver.h"
#include "model/vehicle/build_corner.h"
#include "model/vehicle/model_error.h"
#include "model/vehicle/spec.h"
#include "model/vehicle/vehicle.h"

namespace strut {

/// One car in one maneuver, scalar.
struct AssembledVehicle {
  VehicleLayout layout;
  VehicleParameters<double> numbers;
  std::array<double, kCorners> nominal_load;  // N, at rest
  std::array<double, kCorners> preload;       // N, spring force at nominal trim
  double center_height = 0.0;                 // m, chassis origin over the ground at nominal trim
};

/// Throws ModelError when no such car can stand: chassis mass or inertia not positive, loops that
/// do not close over +-kHalfTravel.
AssembledVehicle assemble_vehicle(const VehicleSpec& spec, const ManeuverSpec& maneuver);

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

/// The spring and damper elements of T numbers.
template <class T>
StrutElements<T> make_strut_elements(const VehicleParameters<T>& numbers) {
  StrutElements<T> elements;
  for (int c = 0; c < kCorners; ++c) {
    std::get<0>(elements).add(c, numbers.spring[c]);
    std::get<1>(elements).add(c, numbers.damper[c]);
  }
  return elements;
}

}  // namespace strut
