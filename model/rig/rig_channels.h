// The order of each rig's channels; names, units and meanings: rig_info.cc.
#pragma once

namespace strut {

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
    kAcceleration,
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
    kGuideForce,
    kCount
  };
};

struct GuidedMassChannel {
  enum : int {
    kTime,
    kBasePosition,
    kPosition,
    kBaseVelocity,
    kVelocity,
    kBaseAcceleration,
    kAcceleration,
    kForce,
    kSpringForce,
    kDamperForce,
    kGuideForce,
    kCount
  };
};

}  // namespace strut
