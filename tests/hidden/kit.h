// A kit: a model, its sensors and the runs of a campaign, for the sampler and the writer.
#pragma once

#include <string>
#include <vector>

#include "tests/hidden/car.h"
#include "tests/hidden/faults.h"
#include "tests/hidden/regime.h"
#include "tests/hidden/road.h"
#include "tests/hidden/sensor.h"

namespace strut::hidden {

enum class KitKind { kCar, kQuarterCar, kDyno };

/// A parameter of the kit's model that a trial may vary, with its name in the model's file; the
/// truth is the nominal value times a factor.
struct KitParameter {
  std::string name, unit;
  double nominal = 0.0;
  double low = 1.0, high = 1.0;  // range of the factor
  double prior = 0.0;            // 1 sigma over nominal of a weighed value; 0: free
  bool survey = false;           // belongs to the maneuver, not to the model's file
};

enum class Excitation { kBump, kFlat, kChirp, kStep, kRough, kSine };

struct RunPlan {
  std::string name;
  bool fit = true;
  double duration = 3.0;  // s
  Excitation excitation = Excitation::kBump;
  double speed = 0.0;  // m/s
  Bump bump;
  int bump_number = 0;  // of the kit's bumps: one survey each
  bool one_sided = false;
  double distance = 0.0;   // m, bump ahead of the front wheels when the recording begins
  double amplitude = 0.0;  // m, of rigs
  double low_frequency = 0.0, high_frequency = 0.0;  // Hz
  bool recorded = true;                              // false: simulated, but not written
};

struct Kit {
  KitKind kind = KitKind::kCar;
  std::string name;
  unsigned bit = kInCar;
  double rate = 500.0;  // Hz
  std::vector<KitParameter> parameters;
  std::vector<Sensor> sensors;
  std::vector<RunPlan> runs;
  double time_sigma = 0.0;   // s, of the hit time
  double speed_sigma = 0.0;  // 1
  double jitter = 2e-5;      // s
  Regime regime = Regime::kExact;
  Contact contact = Contact::kFelt;
};

/// "car", "car_disc" (the same with another contact), "quarter_car" or "dyno"; throws
/// std::invalid_argument for others.
Kit make_kit(const std::string& name, Regime regime = Regime::kExact);

}  // namespace strut::hidden
