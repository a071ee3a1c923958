// Vehicles made in code, for tests that need a car without reading a file.
#pragma once

#include "model/car/spec.h"

namespace strut::reference {

/// The paper's sedan: Table 1, front MacPherson and rear five-link hardpoints of public models,
/// estimated masses. Every mount kind and both strut rod variants can be had from it.
VehicleSpec make_paper_sedan_spec();

/// PAC2002 coefficients of a public sedan tire, enough for pure and combined slip.
Pac2002<double> make_sedan_tire(double unloaded_radius);

}  // namespace strut::reference
