// Channels of the car by name: in sweep files and on the command line.
#pragma once

#include <string>

namespace strut {

/// CarChannel with this name. Throws InputError with the nearest known name and all there are.
int find_car_channel(const std::string& name);

}  // namespace strut
