// A clock for durations.
#pragma once

namespace strut {

/// Time since a fixed but arbitrary moment [s]; never runs backward.
double now();

}  // namespace strut
