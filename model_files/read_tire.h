// A tire from its property file: PAC2002 coefficients and the vertical spring and damper.
#pragma once

#include <filesystem>

#include "model/force/pac2002.h"

namespace strut {

struct TireData {
  Pac2002<double> pacejka;          // a left tire
  double unloaded_radius = 0.0;     // m
  double vertical_stiffness = 0.0;  // N/m
  double vertical_damping = 0.0;    // N s/m
};

/// Reads a PAC2002 property file in SI units. A tire measured on the right (TYRESIDE) is mirrored
/// to the left; USE_MODE 3, 13, 23 removes combined slip. Keys of parts that are not modeled
/// (inflation pressure, extended overturning couple, nonlinear vertical stiffness, ...) must have
/// their neutral values; those of relaxation at standstill, turn slip, belt gyroscopics and rim
/// geometry are ignored.
///
/// Throws InputError "file:line: KEY = value: ..." with the allowed range, for an unknown key with
/// the nearest known one.
TireData read_tire(const std::filesystem::path& path);

}  // namespace strut
