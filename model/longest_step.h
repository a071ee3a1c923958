// Integration steps that a model's effects need. The equations of a plain car or rig are resolved
// by any stable step; contacts and friction of an effect have times of their own.
#pragma once

#include <span>

#include "model/car/case.h"
#include "model/force/strut_effects.h"
#include "model/rig/rig_spec.h"

namespace strut {

/// Longest step [s] that resolves a rig; infinity where nothing limits it. The minimum of
///
///   0.1 / w            w: fastest linear mode, where the phase error of RK4 is 1e-6
///   1.2 / r            r: rate at which the contact at the end of a lost stroke yields, at least
///                      kShortestContact; the error is 1 to 2 % of the effect, 40 % at 4 / r
///   v_s m / F_c        dry friction: 1e-3 of the effect at 1.4 times this step, unstable at 2.7;
///                      with a flank, where that is more, 0.2 sqrt(m b / F_c)
///   0.2 sqrt(m / k_b)  bump stop: 1 % of the effect
///
/// m: the mass that the strut moves (of two the reduced one).
double calc_longest_step(const RigSpec& rig);
/// The same while no joint crosses its play (RigSystem::wants_fine_step): without 1.2 / r.
double calc_longest_settled_step(const RigSpec& rig);

/// Longest step [s] that resolves a car's effects. m: the axle's wheel.
double calc_longest_step(const Case& c);
/// The same where the numbers of its struts' effects, by corner, are made already.
double calc_longest_step(const VehicleSpec& vehicle,
                         std::span<const StrutEffectNumbers<double>, kCorners> struts);

/// Steps [s] below this resolve strokes that no other part of the model notices.
inline constexpr double kShortestContact = 5e-5;

/// `step` halved until it is at most `longest`: few different steps, so that lanes are shared and
/// derivatives seldom meet a change of the step.
double shorten_step(double step, double longest);

}  // namespace strut
