// A rig of every kind with the values of a car's corner.
#pragma once

#include "model/rig/rig_spec.h"

namespace strut::test {

inline RigSpec make_corner_rig(RigKind kind) {
  RigSpec spec;
  spec.kind = kind;
  spec.sprung_mass = kind == RigKind::kStrutRig ? 0.0 : 300.0;
  spec.unsprung_mass = kind == RigKind::kQuarterCar ? 40.0 : 0.0;
  spec.stiffness = 20000.0;
  spec.damping = 1500.0;
  spec.tire_stiffness = 200000.0;
  spec.tire_damping = 100.0;
  spec.gravity = kind == RigKind::kQuarterCar ? 9.81 : 0.0;
  return spec;
}

}  // namespace strut::test
