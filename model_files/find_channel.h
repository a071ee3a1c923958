// Channels by name, for sweep files and the command line.
#pragma once

#include <string>

namespace strut {

struct ModelInfo;

/// The number of a model's channel. Throws InputError with the nearest known name and all channels.
int require_channel(const ModelInfo& model, const std::string& name);

/// The CarChannel of this name. Throws InputError with the nearest known name and all channels.
int find_car_channel(const std::string& name);

}  // namespace strut
