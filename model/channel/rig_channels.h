// What a simulation of a rig reports: a list of names, units and meanings for each kind.
#pragma once

#include <vector>

#include "model/channel/channel_info.h"

namespace strut {

enum class RigKind { kQuarterCar, kStrutRig, kSingleMass };

struct QuarterCarChannel {
  enum : int {
    kTime,
    kRoadPosition,
    kUnsprungPosition,
    kSprungPosition,
    kRoadVelocity,
    kUnsprungVelocity,
    kSprungVelocity,
    kRoadAcceleration,
    kUnsprungAcceleration,
    kSprungAcceleration,
    kActuatorForce,
    kSpringForce,
    kDamperForce,
    kTireForce,
    kCount
  };
};

struct StrutRigChannel {
  enum : int {
    kTime,
    kDisplacement,
    kVelocity,
    kForce,
    kSpringForce,
    kDamperForce,
    kTemperature,
    kCount
  };
};

struct SingleMassChannel {
  enum : int {
    kTime,
    kPosition,
    kVelocity,
    kAcceleration,
    kForce,
    kSpringForce,
    kDamperForce,
    kCount
  };
};

/// The channels of a kind of rig in the order of its enumeration above.
const std::vector<ChannelInfo>& list_rig_channels(RigKind kind);

}  // namespace strut
