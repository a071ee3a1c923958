// Units of measured files and what they are in SI: the only place outside of io where a quantity is
// not SI.
#pragma once

#include <string>

namespace strut {

/// SI value = factor * value + offset.
struct UnitScale {
  double factor = 1.0, offset = 0.0;
};

/// From `unit`, as a file has it, to `si`, the unit of a channel ("m", "m/s^2", "N", "K", ...).
/// An empty unit is SI. Throws InputError that names what is allowed, with the nearest.
UnitScale find_unit_scale(const std::string& unit, const std::string& si);

/// The unit whose numbers are `ratio` times the SI ones, within a third: "mm" for m and 1000; "" if
/// there is none.
std::string guess_unit(const std::string& si, double ratio);

}  // namespace strut
