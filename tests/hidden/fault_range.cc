#include "tests/hidden/fault_range.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace strut::hidden {
namespace {

/// The largest magnitude that is still the thing it is called.
double get_cap(const Kit& kit, const FaultInfo& info) {
  switch (info.fault) {
    case Fault::kAsymmetry:
    case Fault::kKnee:
    case Fault::kSelectiveDamper:
      return 0.8;
    case Fault::kSaturation:
    case Fault::kWarming:
      return 0.6;
    case Fault::kSpeedometer:
      return 0.06;
    case Fault::kParabola:
    case Fault::kTruncatedRamp:
      return 1.2;
    case Fault::kSensorGain:
    case Fault::kRoadGain:
    case Fault::kBumpHeight:
    case Fault::kBumpLength:
      return 0.3;
    default:
      return 10.0 * get_start(kit, info);
  }
}

/// Below it the equations become stiffer than the integrator likes, or nothing is left.
double get_floor(const Kit& kit, const FaultInfo& info) {
  const double start = get_start(kit, info);
  const bool is_stiff =
      info.fault == Fault::kMount || info.fault == Fault::kLag || info.fault == Fault::kPlay;
  return is_stiff ? 0.02 * start : 3e-4 * start;
}

}  // namespace

double get_start(const Kit& kit, const FaultInfo& info) {
  // A dynamometer holds a car's strut.
  return kit.kind == KitKind::kQuarterCar ? info.rig : info.car;
}

std::pair<double, double> find_bracket(const Kit& kit, Fault fault) {
  const FaultInfo& info = get_info(fault);
  return {get_floor(kit, info), get_cap(kit, info)};
}

double find_peak(const Kit& kit, const Truth& truth, const FaultSetting& setting) {
  double peak = 0.0;
  if (setting.fault != Fault::kSaturation) return peak;
  Truth smooth = truth;
  smooth.roughness = 0.0;
  for (const std::vector<Signal>& run : simulate_fit_runs(kit, smooth)) {
    for (const double v : run[static_cast<std::size_t>(setting.place)].value) {
      peak = std::max(peak, std::fabs(v));
    }
  }
  return peak;
}

std::string get_place(const Kit& kit, const FaultSetting& setting) {
  const Where where = get_info(setting.fault).where;
  if (where == Where::kChannel) return kit.sensors[static_cast<std::size_t>(setting.place)].channel;
  if (kit.kind != KitKind::kCar) return "";
  if (where == Where::kBody) return "body";
  if (where == Where::kRoad) return "road";
  return setting.place == 0 ? "front" : "rear";
}

std::string get_where(const Kit& kit, const FaultSetting& setting) {
  std::string place = get_place(kit, setting);
  if (!place.empty()) return place;
  switch (get_info(setting.fault).where) {
    case Where::kTire:
      return "tire";
    case Where::kBody:
      return "body";
    case Where::kRoad:
      return "road";
    default:
      return "strut";
  }
}

}  // namespace strut::hidden
