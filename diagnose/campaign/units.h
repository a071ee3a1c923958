// Units of measured files and their conversion to SI: the only place outside of io with quantities
// that are not SI.
#pragma once

#include <string>

namespace strut {

/// SI value = factor * value + offset.
struct UnitScale {
  double factor = 1.0, offset = 0.0;
};

/// The conversion from a file's `unit` to `si`, the unit of a channel ("m", "m/s^2", "N", "K",
/// ...). An empty unit is SI. Throws InputError with the allowed units and the nearest.
UnitScale find_unit_scale(const std::string& unit, const std::string& si);

/// The unit whose numbers are `ratio` times those in SI, within a third: "mm" for m and 1000; "" if
/// there is none.
std::string guess_unit(const std::string& si, double ratio);

}  // namespace strut
