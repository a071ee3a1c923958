// The catalogue's effects in a car.
#pragma once

#include "model/car/assemble.h"
#include "model/car/case.h"
#include "model/effects/catalogue.h"

namespace strut {

/// Returns the case after the effects that only change its own numbers (wheel masses, bump, speed,
/// position of the sensor); the settings of all other effects remain.
Case apply_case_effects(const Case& c);

/// Applies all other effects of `spec` to the parameters and the layout of an assembled car without
/// effects. Throws ModelError where the mass or the inertia of the chassis is not positive
/// (definite) afterwards.
void set_effects(const VehicleSpec& spec, VehicleLayout& layout,
                 VehicleParameters<double>& numbers);

}  // namespace strut
