#include "tests/hidden/faults.h"

#include <cstddef>

namespace strut::hidden {
namespace {

constexpr unsigned kStands = kInQuarterCar | kInDyno, kAll = kInCar | kStands;

/// The field of a strut's faults that a fault sets; null for those elsewhere.
double StrutFaults::*find_field(Fault fault) {
  switch (fault) {
    case Fault::kAsymmetry:
      return &StrutFaults::asymmetry;
    case Fault::kKnee:
      return &StrutFaults::knee_loss;
    case Fault::kLag:
      return &StrutFaults::gas_lag;
    case Fault::kLeak:
      return &StrutFaults::leak;
    case Fault::kFriction:
      return &StrutFaults::friction;
    case Fault::kHardening:
      return &StrutFaults::hardening;
    case Fault::kStop:
      return &StrutFaults::stop;
    case Fault::kMount:
      return &StrutFaults::mount;
    case Fault::kSelectiveDamper:
      return &StrutFaults::selective;
    case Fault::kSideFriction:
      return &StrutFaults::side_friction;
    case Fault::kInerter:
      return &StrutFaults::inerter;
    case Fault::kPlay:
      return &StrutFaults::play;
    case Fault::kGas:
      return &StrutFaults::gas;
    default:
      return nullptr;
  }
}

void apply_to_wheel(const FaultSetting& s, Wheel& wheel) {
  if (double StrutFaults::*const field = find_field(s.fault))
    wheel.strut.faults.*field = s.magnitude;
  if (s.fault == Fault::kUnsprungMass) wheel.mass += s.magnitude;
  if (s.fault == Fault::kTireStiffness) wheel.tire.stiffness *= 1.0 + s.magnitude;
  if (s.fault == Fault::kTirePower) wheel.tire.exponent = s.magnitude;
  if (s.fault == Fault::kTireDamping) wheel.tire.damping += s.magnitude;
  if (s.fault == Fault::kRunout) wheel.tire.runout = s.magnitude;
}

}  // namespace

const std::vector<FaultInfo>& list_faults() {
  using W = Where;
  static const std::vector<FaultInfo> list = {
      {Fault::kAsymmetry, "handed-over valves", "damper_asymmetry", "asymmetry", W::kStrut, kAll,
       true, 0.1, 0.1},
      {Fault::kKnee, "straight knee", "damper_blow_off", "loss", W::kStrut, kAll, false, 0.2, 0.2},
      {Fault::kLag, "lag", "damper_hysteresis", "lag", W::kStrut, kAll, false, 2e-3, 4e-3},
      {Fault::kLeak, "idle stroke", "damper_leak", "", W::kStrut, kAll, false, 2e-3, 5e-4},
      {Fault::kFriction, "LuGre friction", "strut_friction", "force", W::kStrut, kAll, false, 50.0,
       0.4},
      {Fault::kHardening, "hyperbolic spring", "progressive_spring", "", W::kStrut, kAll, false,
       0.5, 0.5},
      {Fault::kStop, "tabled stop", "bump_stop", "", W::kStrut, kAll, false, 0.3, 0.3},
      {Fault::kMount, "cubic mount", "top_mount_compliance", "", W::kStrut, kAll, false, 1.0, 1.0},
      {Fault::kRollBar, "roll bar", "anti_roll_bar", "stiffness", W::kStrut, kInCar, false, 3000.0,
       0.0},
      {Fault::kPayload, "load in the trunk", "payload", "mass", W::kBody, kInCar, false, 40.0, 0.0},
      {Fault::kCenterShift, "shifted body", "center_of_mass_shift", "", W::kBody, kInCar, true,
       0.03, 0.0},
      {Fault::kPitchInertia, "pitch inertia", "pitch_inertia", "gain", W::kBody, kInCar, true, 0.08,
       0.0},
      {Fault::kUnsprungMass, "wheel mass", "unsprung_mass", "mass", W::kTire, kInCar, true, 4.0,
       0.0},
      {Fault::kTireStiffness, "tire rate", "tire_stiffness", "gain", W::kTire, kInCar, true, 0.1,
       0.0},
      {Fault::kTirePower, "power-law tire", "tire_progressive", "", W::kTire,
       kInCar | kInQuarterCar, false, 0.1, 0.1},
      {Fault::kTireDamping, "tire damping", "tire_damping", "rate", W::kTire, kInCar, false, 200.0,
       0.0},
      {Fault::kCams, "two cams", "tire_enveloping", "", W::kRoad, kInCar, false, 0.08, 0.0},
      {Fault::kRunout, "run-out", "wheel_runout", "amplitude", W::kTire, kInCar, false, 5e-4, 0.0},
      {Fault::kBumpHeight, "bump height", "bump_height", "gain", W::kRoad, kInCar, true, 0.08, 0.0},
      {Fault::kBumpLength, "bump length", "bump_length", "gain", W::kRoad, kInCar, true, 0.08, 0.0},
      {Fault::kRoadGain, "road gain", "road_gain", "gain", W::kRoad, kInQuarterCar, true, 0.0,
       0.02},
      {Fault::kSensorGain, "sensor gain", "sensor_gain", "gain", W::kChannel,
       kInCar | kInQuarterCar, true, 0.03, 0.03},
      {Fault::kSensorDelay, "sensor delay", "sensor_delay", "delay", W::kChannel, kAll, false, 3e-3,
       3e-3},
      {Fault::kSensorLowpass, "sensor low-pass", "sensor_lowpass", "time", W::kChannel, kAll, false,
       3e-3, 3e-3},
      {Fault::kEngine, "engine bounce", "", "", W::kBody, kInCar, false, 60.0, 0.0},
      {Fault::kParabola, "parabolic bump", "", "", W::kRoad, kInCar, false, 0.3, 0.0},
      {Fault::kTruncatedRamp, "flat-topped bump", "", "", W::kRoad, kInCar, false, 0.3, 0.0},
      {Fault::kBodyBending, "body bending", "", "", W::kBody, kInCar, false, 0.3, 0.0},
      {Fault::kSelectiveDamper, "frequency-selective damper", "", "", W::kStrut, kAll, false, 0.2,
       0.2},
      {Fault::kSideFriction, "friction by stroke", "", "", W::kStrut, kAll, false, 80.0, 0.8},
      {Fault::kSaturation, "sensor saturation", "", "", W::kChannel, kAll, false, 0.3, 0.3},
      {Fault::kSeatedPassenger, "passenger on a seat", "", "", W::kBody, kInCar, false, 40.0, 0.0},
      {Fault::kInerter, "inerter", "", "", W::kStrut, kInQuarterCar, false, 0.0, 0.05},
      {Fault::kHum, "hum of a fan", "", "", W::kBody, kInQuarterCar, false, 0.0, 0.3},
      {Fault::kPlay, "worn joint", "joint_play", "play", W::kStrut, kAll, false, 1e-3, 2e-4, true},
      {Fault::kImuPosition, "leaning sensor elsewhere", "sensor_position", "x", W::kBody, kInCar,
       true, 0.05, 0.0, true},
      {Fault::kSpeedometer, "speedometer wrong at speed", "speed_error", "", W::kRoad, kInCar, true,
       0.02, 0.0, true},
      {Fault::kWarming, "damper warming from run to run", "", "", W::kStrut, kAll, false, 0.1, 0.1,
       true},
      {Fault::kGas, "compressed gas", "", "", W::kStrut, kAll, false, 0.1, 0.1, true},
  };
  return list;
}

const FaultInfo& get_info(Fault fault) { return list_faults()[static_cast<std::size_t>(fault)]; }

void apply(const FaultSetting& s, Car& car) {
  const Where where = get_info(s.fault).where;
  if (where == Where::kStrut || where == Where::kTire) {
    const auto axle = static_cast<std::size_t>(s.place);
    apply_to_wheel(s, car.wheel[2 * axle]);
    apply_to_wheel(s, car.wheel[2 * axle + 1]);
    if (s.fault == Fault::kRollBar) car.roll_bar[axle] = s.magnitude;
  }
  if (s.fault == Fault::kPayload) car.payload = s.magnitude;
  if (s.fault == Fault::kCenterShift) car.center_shift = s.magnitude;
  if (s.fault == Fault::kPitchInertia) car.pitch_inertia = s.magnitude;
  if (s.fault == Fault::kImuPosition) {
    constexpr double kLean = 0.2;  // rad/m: a bracket that reaches farther leans farther
    car.imu.x() += s.magnitude;
    car.imu_lean = kLean * s.magnitude;
  }
  if (s.fault == Fault::kBodyBending) car.bending.compliance = s.magnitude;
  if (s.fault == Fault::kSeatedPassenger) {
    car.passenger = {s.magnitude, {-0.2, 0.35, 0.1}, 4.5, 0.3, false};
  }
  if (s.fault == Fault::kEngine) {
    car.passenger = {s.magnitude, {1.2, 0.0, 0.05}, 10.0, 0.06, true};
  }
}

void apply(const FaultSetting& s, StrutLaw& law) {
  if (double StrutFaults::*const field = find_field(s.fault)) law.faults.*field = s.magnitude;
}

void apply(const FaultSetting& s, QuarterCar& car) {
  apply(s, car.strut);
  if (s.fault == Fault::kTirePower) car.tire_exponent = s.magnitude;
  if (s.fault == Fault::kHum) car.hum_force = s.magnitude;
}

}  // namespace strut::hidden
