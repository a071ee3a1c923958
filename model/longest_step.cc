#include "model/longest_step.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "model/car/car_info.h"
#include "model/effects/names.h"
#include "model/effects/strut_numbers.h"
#include "model/rig/rig_info.h"

namespace strut {
namespace {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

double calc_friction_step(const DryFriction<double>& friction, double mass) {
  return friction.force > 0.0 ? mass / (friction.force * friction.inverse_speed) : kUnlimited;
}

/// `mass` [kg]: infinite where the motion is given.
double calc_strut_step(const StrutEffectNumbers<double>& n, double mass) {
  constexpr double kStopRadians = 0.2, kContactTimes = 1.2;
  double longest = calc_friction_step(n.friction, mass);
  if (n.series.play > 0.0) {
    const double contact = kContactTimes / calc_contact_rate(n.series.play);
    longest = std::min(longest, std::max(contact, kShortestContact));
  }
  if (n.stop.stiffness > 0.0) {
    longest = std::min(longest, kStopRadians * std::sqrt(mass / n.stop.stiffness));
  }
  return longest;
}

double calc_moved_mass(const RigSpec& rig) {
  const std::size_t masses = get_rig_info(rig.kind).masses.size();
  if (masses == 0) return kUnlimited;
  if (masses == 1) return rig.sprung_mass;
  return 1.0 / (1.0 / rig.sprung_mass + 1.0 / rig.unsprung_mass);
}

}  // namespace

double calc_longest_step(const RigSpec& rig) {
  constexpr double kModeRadians = 0.1;
  const RigInfo& info = get_rig_info(rig.kind);
  const double mass = calc_moved_mass(rig), mode = info.calc_fastest_mode(rig);
  const StrutEffectNumbers<double> numbers =
      make_strut_effect_numbers({rig.effects, info}, PlaceName::kRig, {});
  const double linear = mode > 0.0 ? kModeRadians / mode : kUnlimited;
  const double guide = calc_friction_step({rig.guide_friction, 1.0 / rig.guide_speed}, mass);
  return std::min({linear, guide, calc_strut_step(numbers, mass)});
}

double calc_longest_step(const VehicleSpec& vehicle,
                         std::span<const StrutEffectNumbers<double>, kCorners> struts) {
  double longest = kUnlimited;
  for (int corner = 0; corner < kCorners; ++corner) {
    const double wheel = vehicle.suspension[axle_of(corner)].wheel_mass;
    longest = std::min(longest, calc_strut_step(struts[corner], wheel));
  }
  return longest;
}

double calc_longest_step(const Case& c) {
  const EffectValues values{c.vehicle.effects, get_car_info()};
  std::array<StrutEffectNumbers<double>, kCorners> struts{};
  for (int corner = 0; corner < kCorners; ++corner) {
    struts[corner] = make_strut_effect_numbers(values, kCornerNames[corner], {});
  }
  return calc_longest_step(c.vehicle, struts);
}

double shorten_step(double step, double longest) {
  while (step > longest * (1.0 + 1e-9)) step *= 0.5;
  return step;
}

}  // namespace strut
