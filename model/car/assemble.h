// From the specification of a vehicle and a maneuver to the parameters of the equations of motion.
#pragma once

#include "model/car/build_corner.h"
#include "model/car/closures.h"
#include "model/car/sides.h"
#include "model/car/spec.h"
#include "model/car/vehicle.h"
#include "model/error/model_error.h"
#include "model/scenario/maneuver.h"

namespace strut {

/// One car in one maneuver.
struct AssembledVehicle {
  VehicleLayout layout;
  VehicleParameters<double> numbers;
  Pac2002<double> pacejka;
  std::array<double, kCorners> nominal_load;  // N, at rest
  std::array<double, kCorners> preload;       // N, spring force at nominal trim
  double center_height = 0.0;                 // m, chassis origin over the ground at nominal trim
};

/// Load on one tire of an axle at rest [N].
double calc_nominal_load(const VehicleSpec& spec, double gravity, int axle);

/// Wheel center at nominal trim relative to the whole car's centroid [m], projected on the car's
/// plane of symmetry (y = 0). Camber reduces the height of the wheel center by its cosine.
Vec3<double> calc_wheel_reference(const VehicleSpec& spec, double gravity, int corner);

/// Assembles a car without effects. Throws ModelError where mass or inertia of the chassis are not
/// positive (definite), a spring does not move with its wheel, or loops do not close over
/// +/-kHalfTravel.
AssembledVehicle assemble_vehicle(const VehicleSpec& spec, const ManeuverSpec& maneuver);

/// Throws ModelError unless the inertia is positive definite.
void check_chassis_inertia(const Sym3<double>& inertia);

/// Sets the springs (with the preload of `car`) and dampers of `spec` and the drive torque of
/// `maneuver`.
void set_operating_parameters(const VehicleSpec& spec, const ManeuverSpec& maneuver,
                              const AssembledVehicle& car, VehicleParameters<double>& numbers);

/// Corner tables of an assembled car; each group of functions gets the minimum degree that resolves
/// it to kTableTolerance. Throws ModelError where kTableTerms do not suffice.
VehicleTables<double> tabulate_corners(const AssembledVehicle& car);

/// The properties of the car's tires that determine their effective road.
ContactGeometry make_contact(const VehicleSpec& spec);

/// The effective road under this car's wheels, by tire radius and contact model.
Surface make_surface(const VehicleSpec& spec, const ManeuverSpec& maneuver);

/// World x of the bump center: `bump_distance` ahead of the nominal front wheel centers when the
/// chassis origin starts at x = 0.
double calc_bump_center(const AssembledVehicle& car, const ManeuverSpec& maneuver);

/// Fills the lists of spring, damper and effect elements of the computed corners from the vehicle's
/// parameters, and the list of force maps from the maps of each lane.
template <Sides S = Sides::kBoth, class T>
void fill_strut_elements(Vehicle<T>& vehicle, const CornerForceMaps* const* maps = nullptr) {
  static_assert(kCorners <= kMaxElements, "each corner adds at most one element of a kind");
  const VehicleLayout& layout = vehicle.layout;
  const VehicleParameters<T>& numbers = vehicle.numbers;
  vehicle.struts = {};
  vehicle.effects = {};
  for (int c = 0; c < kCorners; c += kCornerStride<S>) {
    const unsigned bits = layout.strut_effects[c];
    std::get<0>(vehicle.struts).add(c, numbers.spring[c]);
    if ((bits & kShapedDamper) == 0) std::get<1>(vehicle.struts).add(c, numbers.damper[c]);
    vehicle.effects.add(c, bits, numbers.effects[c], layout.damper_curve[axle_of(c)]);
  }
  for (int axle = 0; axle < kAxles; ++axle) {
    // Bars exert no force in a symmetric motion.
    if (S == Sides::kLeft || !layout.has_anti_roll_bar[axle]) continue;
    vehicle.effects.add_bar(2 * axle, numbers.anti_roll_bar[axle]);
  }
  if (maps == nullptr) return;
  const auto get_length = [&](int c) { return numbers.nominal_length[c * kLines + kDamperLine]; };
  vehicle.effects.add_maps(maps, get_length, static_cast<std::size_t>(kCornerStride<S>));
}

}  // namespace strut
