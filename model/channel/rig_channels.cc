#include "model/channel/rig_channels.h"

#include <array>
#include <cstddef>

namespace strut {
namespace {

std::vector<ChannelInfo> make_quarter_car_channels() {
  return {{"time", "s", "time since the start"},
          {"road_position", "m", "height of the road under the tire"},
          {"unsprung_position", "m", "unsprung mass, from rest"},
          {"sprung_position", "m", "sprung mass, from rest"},
          {"road_velocity", "m/s", "rate of road_position"},
          {"unsprung_velocity", "m/s", "unsprung mass"},
          {"sprung_velocity", "m/s", "sprung mass"},
          {"road_acceleration", "m/s^2", "rate of road_velocity"},
          {"unsprung_acceleration", "m/s^2", "unsprung mass, gravity not included"},
          {"sprung_acceleration", "m/s^2", "sprung mass, gravity not included"},
          {"actuator_force", "N", "between the masses, pushes them apart"},
          {"spring_force", "N", "strut's spring, positive in compression"},
          {"damper_force", "N", "strut's damper, positive in compression"},
          {"tire_force", "N", "of the road on the tire, upwards, static load included"}};
}

std::vector<ChannelInfo> make_strut_rig_channels() {
  return {{"time", "s", "time since the start"},
          {"displacement", "m", "compression of the strut"},
          {"velocity", "m/s", "rate of displacement"},
          {"force", "N", "of the whole strut, positive in compression"},
          {"spring_force", "N", "strut's spring, positive in compression"},
          {"damper_force", "N", "strut's damper, positive in compression"},
          {"temperature", "K", "of the damper, as given"}};
}

std::vector<ChannelInfo> make_single_mass_channels() {
  return {{"time", "s", "time since the start"},
          {"position", "m", "from rest"},
          {"velocity", "m/s", "rate of position"},
          {"acceleration", "m/s^2", "rate of velocity"},
          {"force", "N", "applied to the mass, as given"},
          {"spring_force", "N", "spring to ground, positive in compression"},
          {"damper_force", "N", "damper to ground, positive in compression"}};
}

}  // namespace

const std::vector<ChannelInfo>& list_rig_channels(RigKind kind) {
  static const std::array<std::vector<ChannelInfo>, 3> lists = {
      make_quarter_car_channels(), make_strut_rig_channels(), make_single_mass_channels()};
  return lists[static_cast<std::size_t>(kind)];
}

}  // namespace strut
