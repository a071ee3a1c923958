// A tire from its property file: PAC2002 coefficients and the vertical spring and damper.
#pragma once

#include <filesystem>

#include "model/force/force_curve.h"
#include "model/force/pac2002.h"

namespace strut {

struct TireData {
  Pac2002<double> pacejka;          // a left tire
  double unloaded_radius = 0.0;     // m
  double vertical_stiffness = 0.0;  // N/m
  double vertical_damping = 0.0;    // N s/m
  ForceCurveSpec vertical_curve;    // of DEFLECTION_LOAD_CURVE, in place of vertical_stiffness
};

/// Reads a PAC2002 property file in SI units. A tire measured on the right (TYRESIDE) is mirrored
/// to the left; USE_MODE 3, 13, 23 removes combined slip; a DEFLECTION_LOAD_CURVE {pen fz} takes
/// the place of VERTICAL_STIFFNESS, which becomes the rate of the curve. Keys of parts that are not
/// modeled (inflation pressure, extended overturning couple, nonlinear vertical stiffness, ...)
/// must have their neutral values; those of relaxation at standstill, turn slip, belt gyroscopics
/// and rim geometry are ignored.
///
/// Throws InputError "file:line: KEY = value: ..." with the allowed range, for an unknown key with
/// the nearest known one.
TireData read_tire(const std::filesystem::path& path);

}  // namespace strut
