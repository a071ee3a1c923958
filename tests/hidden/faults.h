// Faults that a trial may hide: names, sizes, and where each is set in the generator's own models.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/hidden/car.h"
#include "tests/hidden/rigs.h"

namespace strut::hidden {

enum class Fault : int {
  kAsymmetry,
  kKnee,
  kLag,
  kLeak,
  kFriction,
  kHardening,
  kStop,
  kMount,
  kRollBar,
  kPayload,
  kCenterShift,
  kPitchInertia,
  kUnsprungMass,
  kTireStiffness,
  kTirePower,
  kTireDamping,
  kCams,
  kRunout,
  kBumpHeight,
  kBumpLength,
  kRoadGain,
  kSensorGain,
  kSensorDelay,
  kSensorLowpass,
  // In no catalogue:
  kEngine,
  kParabola,
  kTruncatedRamp,
  kBodyBending,
  kSelectiveDamper,
  kSideFriction,
  kSaturation,
  kSeatedPassenger,
  kInerter,
  kHum,
  // Hidden by seeds from kNewerFaults on:
  kPlay,
  kImuPosition,
  kSpeedometer,
  kWarming,
  kGas,
  kCount
};

enum class Where { kStrut, kTire, kBody, kRoad, kChannel };

enum KitBits : unsigned { kInCar = 1, kInQuarterCar = 2, kInDyno = 4 };

struct FaultInfo {
  Fault fault;
  const char* name;       // in the generator
  const char* effect;     // in the catalogue; "": not in it
  const char* parameter;  // of the effect that equals magnitude * scale; "": the forms differ
  Where where;
  unsigned kits;
  bool either_sign;
  double car, rig;     // start values of a search for the magnitude
  bool newer = false;  // hidden by seeds from kNewerFaults on
};

/// Seeds below it hide the same faults as before the newer ones were added.
inline constexpr std::uint64_t kNewerFaults = 1000;

const std::vector<FaultInfo>& list_faults();
const FaultInfo& get_info(Fault fault);

/// A fault at a place: the axle (0 front, 1 rear) of struts and tires, the sensor's number of
/// channels, else 0.
struct FaultSetting {
  Fault fault = Fault::kAsymmetry;
  int place = 0;
  double magnitude = 0.0;
  double peak = 0.0;  // a sensor's largest reading in SI, the unit of saturation
};

/// Sets faults of struts, tires and masses; faults of road and sensors change nothing here.
void apply(const FaultSetting& setting, Car& car);
void apply(const FaultSetting& setting, QuarterCar& car);
void apply(const FaultSetting& setting, StrutLaw& law);

}  // namespace strut::hidden
