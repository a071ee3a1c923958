#include "model/car/car_info.h"

#include "model/channel/car_channels.h"

namespace strut {
namespace {

using C = CarChannel;

std::vector<StrutInfo> list_struts() {
  std::vector<StrutInfo> struts;
  for (int corner = 0; corner < kCorners; ++corner) {
    const auto at = [corner](int channel) { return C::get_corner_channel(corner, channel); };
    const std::string axle = kAxleNames[static_cast<std::size_t>(axle_of(corner))];
    struts.push_back({axle,
                      axle + "_suspension_deflection",
                      axle + "_suspension_velocity",
                      {{at(C::kSuspensionDeflection), 1.0}},
                      {{at(C::kSuspensionVelocity), 1.0}},
                      at(C::kSpringForce),
                      at(C::kDamperForce)});
  }
  return struts;
}

/// States of the axles, each the mean of two corners.
std::vector<StateInfo> list_states() {
  std::vector<StateInfo> states;
  for (int axle = 0; axle < kAxles; ++axle) {
    const std::string place = kAxleNames[static_cast<std::size_t>(axle)];
    const auto mean = [axle](int channel) {
      return ChannelSum{{C::get_corner_channel(2 * axle, channel), 0.5},
                        {C::get_corner_channel(2 * axle + 1, channel), 0.5}};
    };
    states.push_back({StateKind::kDeflection, place, place + "_suspension_deflection", "m",
                      mean(C::kSuspensionDeflection)});
    states.push_back({StateKind::kVelocity, place, place + "_suspension_velocity", "m/s",
                      mean(C::kSuspensionVelocity)});
    states.push_back(
        {StateKind::kTireLoad, place, place + "_tire_load", "N", mean(C::kTireForceZ)});
  }
  return states;
}

ModelInfo make_car_info() {
  ModelInfo info;
  info.name = "full_vehicle";
  info.parts = kHasCar | kHasTire | kHasSprungMass | kHasStaticForce;
  info.channels = list_car_channels();
  info.struts = list_struts();
  info.states = list_states();
  return info;
}

}  // namespace

const ModelInfo& get_car_info() {
  static const ModelInfo info = make_car_info();
  return info;
}

}  // namespace strut
