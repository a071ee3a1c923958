// The catalogue's effects in a car.
#pragma once

#include "model/car/assemble.h"
#include "model/car/case.h"
#include "model/effects/catalogue.h"

namespace strut {

/// The case with those effects put into it that are nothing but other numbers of car and maneuver
/// (wheel masses, bump, speed, place of the sensor); the settings of the others remain.
Case apply_case_effects(const Case& c);

/// Puts all other effects of `spec` into the numbers of a car and writes to its layout which are
/// on; both are those of an assembled car, without effects. Throws ModelError where what is left of
/// the chassis is no body.
void set_effects(const VehicleSpec& spec, VehicleLayout& layout,
                 VehicleParameters<double>& numbers);

}  // namespace strut
