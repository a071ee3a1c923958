// Names of the catalogue's effects and of the places of a car. Code that refers to an effect uses
// these constants, so that a misspelled name does not compile.
#pragma once

namespace strut {

struct EffectName {
  // strut_effects.cc
  static constexpr const char* kDamperAsymmetry = "damper_asymmetry";
  static constexpr const char* kDamperBlowOff = "damper_blow_off";
  static constexpr const char* kDamperHysteresis = "damper_hysteresis";
  static constexpr const char* kDamperLeak = "damper_leak";
  static constexpr const char* kDamperFade = "damper_fade";
  static constexpr const char* kStrutFriction = "strut_friction";
  static constexpr const char* kProgressiveSpring = "progressive_spring";
  static constexpr const char* kBumpStop = "bump_stop";
  static constexpr const char* kTopMountCompliance = "top_mount_compliance";
  static constexpr const char* kJointPlay = "joint_play";
  static constexpr const char* kGasForce = "gas_force";
  static constexpr const char* kAntiRollBar = "anti_roll_bar";
  // body_effects.cc
  static constexpr const char* kPayload = "payload";
  static constexpr const char* kCenterOfMassShift = "center_of_mass_shift";
  static constexpr const char* kPitchInertia = "pitch_inertia";
  static constexpr const char* kUnsprungMass = "unsprung_mass";
  static constexpr const char* kTireStiffness = "tire_stiffness";
  static constexpr const char* kTireProgressive = "tire_progressive";
  static constexpr const char* kTireDamping = "tire_damping";
  static constexpr const char* kTireEnveloping = "tire_enveloping";
  static constexpr const char* kWheelRunout = "wheel_runout";
  static constexpr const char* kBumpHeight = "bump_height";
  static constexpr const char* kBumpLength = "bump_length";
  static constexpr const char* kSpeedError = "speed_error";
  static constexpr const char* kRoadGain = "road_gain";
  static constexpr const char* kAerodynamicLift = "aerodynamic_lift";
  // sensor_effects.cc
  static constexpr const char* kSensorGain = "sensor_gain";
  static constexpr const char* kSensorBias = "sensor_bias";
  static constexpr const char* kSensorDelay = "sensor_delay";
  static constexpr const char* kClockOffset = "clock_offset";
  static constexpr const char* kSensorLowpass = "sensor_lowpass";
  static constexpr const char* kSensorPosition = "sensor_position";
};

/// Places other than axles and corners (base/names/corners.h) and channels.
struct PlaceName {
  static constexpr const char* kRig = "";  // the only place of a rig
  static constexpr const char* kBody = "body";
  static constexpr const char* kRoad = "road";
};

}  // namespace strut
