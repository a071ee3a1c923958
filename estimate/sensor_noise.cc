#include "estimate/sensor_noise.h"

#include <fmt/format.h>

#include <span>

#include "base/error/input_error.h"
#include "base/text/format_number.h"
#include "base/text/range.h"
#include "model_files/find_channel.h"
#include "model_files/parameters.h"

namespace strut {
namespace {

using C = CarChannel;

struct ChannelNoise {
  int channel;
  double sigma;
};

/// Body motion as reported by inertial navigation or a fusion filter; accelerometers and gyroscopes
/// of the MEMS class with a bandwidth of about 250 Hz.
constexpr ChannelNoise kBodyNoise[] = {
    {C::kBodyPositionZ, 1e-3},    {C::kBodyVelocityZ, 5e-3},    {C::kBodyAccelerationZ, 0.02},
    {C::kPitchAngle, 3.5e-4},     {C::kPitchRate, 1e-3},        {C::kRollAngle, 3.5e-4},
    {C::kRollRate, 1e-3},         {C::kForwardSpeed, 0.05},     {C::kImuAccelerationX, 0.02},
    {C::kImuAccelerationY, 0.02}, {C::kImuAccelerationZ, 0.02}, {C::kImuRateX, 1e-3},
    {C::kImuRateY, 1e-3},         {C::kImuRateZ, 1e-3}};
constexpr ChannelNoise kCornerNoise[] = {{C::kWheelAccelerationZ, 0.2},
                                         {C::kSuspensionDeflection, 3e-4},
                                         {C::kSuspensionVelocity, 5e-3},
                                         {C::kWheelSpeed, 0.1}};

/// Data sheets of MEMS sensors give zero-g offsets of 20 mg (BMI088) to 60 mg and zero-rate offsets
/// of 0.5 to 3 deg/s; 30 mg and 1.1 deg/s lie between. The others are assumptions. Velocities have
/// none.
constexpr double kAccelerationBias = 0.3;  // m/s^2
constexpr double kRateBias = 0.02;         // rad/s
constexpr double kAngleBias = 5e-3;        // rad
constexpr ChannelNoise kBodyBias[] = {{C::kBodyPositionZ, 5e-3},
                                      {C::kBodyAccelerationZ, kAccelerationBias},
                                      {C::kPitchAngle, kAngleBias},
                                      {C::kPitchRate, kRateBias},
                                      {C::kRollAngle, kAngleBias},
                                      {C::kRollRate, kRateBias},
                                      {C::kImuAccelerationX, kAccelerationBias},
                                      {C::kImuAccelerationY, kAccelerationBias},
                                      {C::kImuAccelerationZ, kAccelerationBias},
                                      {C::kImuRateX, kRateBias},
                                      {C::kImuRateY, kRateBias},
                                      {C::kImuRateZ, kRateBias}};
constexpr ChannelNoise kCornerBias[] = {{C::kWheelAccelerationZ, kAccelerationBias},
                                        {C::kSuspensionDeflection, 2e-3}};

/// Sigmas of the body's and each corner's channels; 0 elsewhere.
SensorNoise make_sigmas(std::span<const ChannelNoise> body, std::span<const ChannelNoise> corner) {
  SensorNoise sigmas(C::kCount, 0.0);
  for (const ChannelNoise& n : body) sigmas[static_cast<std::size_t>(n.channel)] = n.sigma;
  for (int i = 0; i < kCorners; ++i) {
    for (const ChannelNoise& n : corner) {
      const int channel = C::get_corner_channel(i, n.channel);
      sigmas[static_cast<std::size_t>(channel)] = n.sigma;
    }
  }
  return sigmas;
}

}  // namespace

SensorNoise make_default_noise() { return make_sigmas(kBodyNoise, kCornerNoise); }

SensorNoise make_default_bias() { return make_sigmas(kBodyBias, kCornerBias); }

void apply_noise(SensorNoise& noise, const std::string& setting) {
  const NamedValue given = parse_setting(setting);
  const auto channel = static_cast<std::size_t>(find_car_channel(given.name));
  const std::string& unit = list_car_channels()[channel].unit;
  const double sigma = given.to_si(unit);
  const Range allowed = above(0.0, unit);
  if (!allowed.contains(sigma)) {
    throw InputError(
        fmt::format("{} = {}: {}", given.name, format_number(sigma), allowed.describe()));
  }
  noise[channel] = sigma;
}

std::vector<double> take_channels(const SensorNoise& noise, const std::vector<std::string>& names) {
  std::vector<double> taken;
  taken.reserve(names.size());
  for (const std::string& name : names) {
    taken.push_back(noise[static_cast<std::size_t>(find_car_channel(name))]);
  }
  return taken;
}

std::vector<int> list_sensors(const SensorNoise& noise) {
  std::vector<int> channels;
  for (std::size_t c = 0; c < noise.size(); ++c) {
    if (noise[c] > 0.0) channels.push_back(static_cast<int>(c));
  }
  return channels;
}

}  // namespace strut
