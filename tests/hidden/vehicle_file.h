// Writes the generator's car as a vehicle file of the tested program.
#pragma once

#include <string>

#include "tests/hidden/car.h"

namespace strut::hidden {

/// A vehicle file of the same car without its faults. The straight guides become struts whose arms
/// are 10 m long: at 50 mm of travel a contact patch moves 0.02 mm sideways. The tire's file is
/// `tire_file`.
std::string make_vehicle_file(const Car& car, double footprint, const std::string& tire_file);

/// The PAC2002 property file of the tire.
std::string make_tire_file(const Tire& tire, double nominal_load);

/// A number with all its digits.
std::string format(double value);

}  // namespace strut::hidden
