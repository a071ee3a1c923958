// One car in one maneuver, the subject of one simulation.
#pragma once

#include "model/car/spec.h"
#include "model/scenario/maneuver.h"

namespace strut {

struct Case {
  VehicleSpec vehicle;
  ManeuverSpec maneuver;
  bool operator==(const Case&) const = default;
};

}  // namespace strut
