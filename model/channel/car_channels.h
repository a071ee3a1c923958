// The channels of a simulated car: one list of names, units and meanings.
#pragma once

#include <vector>

#include "base/names/corners.h"
#include "model/channel/channel_info.h"

namespace strut {

/// Order of the channels: those of the body, then kCornerChannels for each corner in Corner order.
struct CarChannel {
  enum : int {
    kTime,
    kBodyPositionZ,
    kBodyVelocityZ,
    kBodyAccelerationZ,
    kPitchAngle,
    kPitchRate,
    kRollAngle,
    kRollRate,
    kForwardPosition,
    kForwardSpeed,
    kImuAccelerationX,
    kImuAccelerationY,
    kImuAccelerationZ,
    kImuRateX,
    kImuRateY,
    kImuRateZ,
    kCornerBegin,
  };
  enum : int {
    kWheelPositionZ,
    kWheelAccelerationZ,
    kSuspensionDeflection,
    kSuspensionVelocity,
    kSpringForce,
    kDamperForce,
    kTireForceX,
    kTireForceY,
    kTireForceZ,
    kTireDeflection,
    kWheelSpeed,
    kCornerChannels,
  };
  static constexpr int kCount = kCornerBegin + kCorners * kCornerChannels;

  /// The number of a corner's channel, such as kWheelPositionZ.
  static constexpr int get_corner_channel(int corner, int channel) {
    return kCornerBegin + corner * kCornerChannels + channel;
  }
};

/// The car's channels in CarChannel order.
const std::vector<ChannelInfo>& list_car_channels();

}  // namespace strut
