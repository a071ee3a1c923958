// Cases that share a mechanism, which are cheap to run one after the other.
#pragma once

#include "model/car/case.h"

namespace strut {

/// True if both cases have the same mechanism (simulation.h): they may differ in springs, dampers,
/// preload, speed, torque, trim, duration and the bump's distance.
bool shares_mechanism(const Case& a, const Case& b);

}  // namespace strut
