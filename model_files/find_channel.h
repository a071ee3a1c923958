// Channels of the car by name, for sweep files and the command line.
#pragma once

#include <string>

namespace strut {

/// The CarChannel of this name. Throws InputError with the nearest known name and all channels.
int find_car_channel(const std::string& name);

}  // namespace strut
