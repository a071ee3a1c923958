// Noise of a car's sensors: the standard deviation of white noise per sample, and of the constant
// bias of a record, by channel.
#pragma once

#include <string>
#include <vector>

#include "model/channel/car_channels.h"

namespace strut {

/// One sigma by channel [CarChannel::kCount] in the channel's unit; 0: no such sensor.
using SensorNoise = std::vector<double>;

/// Defaults for body, inertial sensor, wheel acceleration, suspension deflection and velocity, and
/// wheel speed, with reasons in docs/identifiability.md. Forces, tire deflections, time and
/// position have no sensor.
SensorNoise make_default_noise();

/// Standard deviations of the sensors' biases, each constant during a record: accelerometers
/// 0.3 m/s^2, gyroscopes 0.02 rad/s, angles 5 mrad, heights 5 mm, suspension deflection 2 mm,
/// others none (reasons in docs/fit.md).
SensorNoise make_default_bias();

/// Applies "channel=sigma". Throws InputError for another form, an unknown channel, or a sigma that
/// is not positive.
void apply_noise(SensorNoise& noise, const std::string& setting);

/// The sigmas of the named channels. Throws InputError with the nearest known name.
std::vector<double> take_channels(const SensorNoise& noise, const std::vector<std::string>& names);

/// Channels that have a sensor, in order.
std::vector<int> list_sensors(const SensorNoise& noise);

}  // namespace strut
