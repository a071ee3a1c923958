// Which cases are cheap to run one after the other.
#pragma once

#include "model/car/case.h"

namespace strut {

/// True if one mechanism (simulation.h) serves both cases: at most springs, dampers, preload,
/// speed, torque, trim, duration and the bump's distance differ.
bool shares_mechanism(const Case& a, const Case& b);

}  // namespace strut
