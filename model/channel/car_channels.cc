#include "model/channel/car_channels.h"

namespace strut {
namespace {

std::vector<ChannelInfo> make_car_channels() {
  std::vector<ChannelInfo> list{
      {"time", "s", "time since the start of the maneuver"},
      {"body_position_z", "m",
       "height over flat ground of the chassis point at the whole car's centroid at nominal trim"},
      {"body_velocity_z", "m/s", "vertical velocity of that point"},
      {"body_acceleration_z", "m/s^2", "vertical acceleration of that point, without gravity"},
      {"pitch_angle", "rad", "pitch, positive nose down"},
      {"pitch_rate", "rad/s", "time derivative of pitch_angle"},
      {"roll_angle", "rad", "roll, positive left side up"},
      {"roll_rate", "rad/s", "time derivative of roll_angle"},
      {"forward_position", "m", "world x of that point, zero at the start"},
      {"forward_speed", "m/s", "world x velocity of that point"},
      {"imu_acceleration_x", "m/s^2", "accelerometer reading at the sensor, forward, with gravity"},
      {"imu_acceleration_y", "m/s^2", "accelerometer reading at the sensor, left, with gravity"},
      {"imu_acceleration_z", "m/s^2", "accelerometer reading at the sensor, up, with gravity"},
      {"imu_rate_x", "rad/s", "gyroscope reading about the chassis x axis"},
      {"imu_rate_y", "rad/s", "gyroscope reading about the chassis y axis"},
      {"imu_rate_z", "rad/s", "gyroscope reading about the chassis z axis"},
  };
  const ChannelInfo corner[CarChannel::kCornerChannels] = {
      {"wheel_position_z", "m", "height of the wheel center"},
      {"wheel_acceleration_z", "m/s^2", "vertical acceleration of the wheel center"},
      {"suspension_deflection", "m", "shortening of the spring since nominal trim"},
      {"suspension_velocity", "m/s", "time derivative of suspension_deflection"},
      {"spring_force", "N", "spring force, positive in compression"},
      {"damper_force", "N", "damper force, positive in compression"},
      {"tire_force_x", "N", "longitudinal force on the tire, contact frame"},
      {"tire_force_y", "N", "lateral force on the tire, contact frame"},
      {"tire_force_z", "N", "load of the tire, along the effective road normal"},
      {"tire_deflection", "m", "tire deflection, negative off the ground"},
      {"wheel_speed", "rad/s", "spin of the wheel relative to its upright"},
  };
  for (const char* name : kCornerNames) {
    for (const ChannelInfo& c : corner) {
      list.push_back({std::string(name) + "_" + c.name, c.unit, c.description});
    }
  }
  return list;
}

}  // namespace

const std::vector<ChannelInfo>& list_car_channels() {
  static const std::vector<ChannelInfo> list = make_car_channels();
  return list;
}

}  // namespace strut
