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

constexpr double kSpringRadians = 0.2;  // of a stop or a flank

/// A flank softens friction; one that is so stiff that its spring is the faster is passive.
double calc_friction_step(const DryFriction<double>& friction, double mass) {
  if (!(friction.force > 0.0)) return kUnlimited;
  const double rigid = mass / (friction.force * friction.inverse_speed);
  return std::max(rigid, kSpringRadians * std::sqrt(mass * friction.stroke / friction.force));
}

double calc_contact_step(const StrutEffectNumbers<double>& n) {
  constexpr double kContactTimes = 1.2;
  if (!(n.series.play > 0.0)) return kUnlimited;
  return std::max(kContactTimes / calc_contact_rate(n.series.play), kShortestContact);
}

/// `mass` [kg]: infinite where the motion is given.
double calc_settled_step(const StrutEffectNumbers<double>& n, double mass) {
  const double friction = calc_friction_step(n.friction, mass);
  if (!(n.stop.stiffness > 0.0)) return friction;
  return std::min(friction, kSpringRadians * std::sqrt(mass / n.stop.stiffness));
}

double calc_strut_step(const StrutEffectNumbers<double>& n, double mass) {
  return std::min(calc_settled_step(n, mass), calc_contact_step(n));
}

double calc_moved_mass(const RigSpec& rig) {
  const std::size_t masses = get_rig_info(rig.kind).masses.size();
  if (masses == 0) return kUnlimited;
  if (masses == 1) return rig.sprung_mass;
  return 1.0 / (1.0 / rig.sprung_mass + 1.0 / rig.unsprung_mass);
}

double calc_guide_step(const RigSpec& rig) {
  const double inverse_speed = 1.0 / rig.guide_speed;
  return std::min(
      calc_friction_step({rig.guide_friction, inverse_speed, rig.guide_stroke}, rig.sprung_mass),
      calc_friction_step({rig.unsprung_guide_friction, inverse_speed, rig.guide_stroke},
                         rig.unsprung_mass));
}

StrutEffectNumbers<double> make_numbers(const RigSpec& rig) {
  return make_strut_effect_numbers({rig.effects, get_rig_info(rig.kind)}, PlaceName::kRig, {});
}

}  // namespace

double calc_longest_step(const RigSpec& rig) {
  return std::min(calc_longest_settled_step(rig), calc_contact_step(make_numbers(rig)));
}

double calc_longest_settled_step(const RigSpec& rig) {
  constexpr double kModeRadians = 0.1;
  const double mass = calc_moved_mass(rig);
  const double mode = get_rig_info(rig.kind).calc_fastest_mode(rig);
  const double linear = mode > 0.0 ? kModeRadians / mode : kUnlimited;
  return std::min({linear, calc_guide_step(rig), calc_settled_step(make_numbers(rig), mass)});
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
