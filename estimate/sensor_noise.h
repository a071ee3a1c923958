// The sensors of a car and their noise: one standard deviation of white noise per channel and
// sample, and of the constant bias of a record.
#pragma once

#include <string>
#include <vector>

#include "model/channel/car_channels.h"

namespace strut {

/// One sigma per channel in its unit [CarChannel::kCount]; 0: no such sensor.
using SensorNoise = std::vector<double>;

/// Defaults for body, inertial sensor, wheel acceleration, suspension deflection and velocity, and
/// wheel speed (docs/identifiability.md gives each with its reason). Forces, tire deflections,
/// time and place have none.
SensorNoise make_default_noise();

/// 1 sigma of a sensor's bias, which is one unknown number in all of a record: accelerometers
/// 0.3 m/s^2, gyroscopes 0.02 rad/s, angles 5 mrad, heights 5 mm, suspension deflection 2 mm,
/// others none (docs/fit.md gives each with its reason).
SensorNoise make_default_bias();

/// Applies "channel=sigma". Throws InputError where the text is not that or sigma is not positive.
void apply_noise(SensorNoise& noise, const std::string& setting);

/// The sigmas of channels by name. Throws InputError with the nearest known name.
std::vector<double> take_channels(const SensorNoise& noise, const std::vector<std::string>& names);

/// Channels that have a sensor, in order.
std::vector<int> list_sensors(const SensorNoise& noise);

}  // namespace strut
