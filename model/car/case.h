// One car in one maneuver: what a single simulation is about.
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
