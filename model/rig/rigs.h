// Test stands from the car's force elements: quarter car, strut on a dynamometer, single mass,
// guided mass on a moving base.
//
// Positions are displacements from the rest position, up positive: from the static equilibrium
// under gravity at ground position zero (masses), or from the relaxed spring (strut_rig, whose
// displacement is positive in compression). Forces are total and include the static load. Forces of
// strut and actuator are positive where they push their two ends apart. With gravity = 0, and for
// any rig whose tire cannot lift off, the motion is therefore that of the deviations from rest.
//
//   quarter_car  m_u a_u = F_t - F_s - F_a + F_gu - m_u g,   m_s a_s = F_s + F_a + F_gs - m_s g
//   single_mass  m a = F + F_s + F_g - m g
//   strut_rig    F = F_s + m_m a at the given displacement, its rate and second rate a
//   guided_mass  m a = F + F_s + F_g - m g
//
//   F_g = -f (1 + A sgn z) z, z = tanh(v / v_f),   F_a = u + g_d (z_s - z_u) + g_s v_s + g_t (z_u -
//   z_r)
//                                               + g_u v_u
//
// F_s: sum of the strut's elements, F_t: tire, F: applied force, F_g: friction of the guide on a
// mass (f: guide_friction or unsprung_guide_friction, A: guide_asymmetry, v_f: guide_speed; with a
// guide_stroke z is that of calc_elastic_friction), F_a:
// actuator force (u: as recorded, g: the gains of the feedback), m_m: moving_mass. The strut of the
// guided mass stands on the base, whose position is an input.
#pragma once

#include <array>
#include <vector>

#include "model/force/strut_effects.h"
#include "model/force/tire_contact.h"
#include "model/rig/rig_info.h"

namespace strut {

inline constexpr int kMaxRigInputs = 2;

/// The signals in the order of the rig's inputs, null where none is given. Throws ModelError for an
/// unknown input, one that is given twice and a missing required one.
std::array<const InputSignal*, kMaxRigInputs> assign_rig_inputs(
    RigKind kind, const std::vector<InputSignal>& inputs);

/// Numbers of one rig: fields of T only, so that W of them pack into lanes.
template <class T>
struct RigParameters {
  std::array<T, kRigCoordinates> mass;              // kg, by RigCoordinate
  std::array<T, kRigCoordinates> initial_position;  // m, offset from rest
  std::array<T, kRigCoordinates> initial_velocity;  // m/s
  LinearSpring<T> spring;
  LinearDamper<T> damper;
  StrutEffectNumbers<T> effects;
  TireVertical<T> tire;
  std::array<DryFriction<T>, kRigCoordinates> guide;  // by RigCoordinate
  T guide_asymmetry;
  T moving_mass;              // kg
  std::array<T, 4> feedback;  // of deflection, sprung velocity, tire deflection, unsprung velocity
  T static_deflection;        // m, of the tire at rest
  T ground_gain;              // factor on the input that moves the ground
  T gravity;                  // m/s^2
  T temperature;              // K
};

/// The properties common to all simulations of a batch.
struct RigLayout {
  RigKind kind = RigKind::kQuarterCar;
  bool unilateral_tire = false;
  unsigned strut_effects = 0;  // StrutEffectBits
  bool progressive_tire = false;
  bool has_guide = false;     // with friction
  bool has_flanks = false;    // of the guides' friction
  bool has_feedback = false;  // of the force between the masses
  std::shared_ptr<const ForceCurve> damper_curve{}, tire_curve{};
};

template <class T>
struct Rig {
  RigLayout layout;
  RigParameters<T> numbers;
  StrutElements<T> struts;
  StrutEffects<T> effects{};
};

/// The strut of `rig` mounted in a strut_rig, with those of its effects that have the same
/// parameters there.
RigSpec take_strut(const RigSpec& rig);

/// Numbers of a rig at its rest position. Throws ModelError as validate does.
RigParameters<double> make_rig_parameters(const RigSpec& spec);

/// Layout of rigs that may share lanes. Throws ModelError where kind, tire contact or a curve
/// differ.
RigLayout make_rig_layout(const RigSpec* const specs[], const RigParameters<double>* numbers,
                          int count);

/// The force map of a rig; null where it has none.
using RigForceMap = std::array<std::shared_ptr<const ForceMapTable>, 1>;
RigForceMap make_rig_force_map(const RigSpec& spec);

/// One rig for each lane.
template <class T>
Rig<T> make_rig(const RigSpec* const specs[]) {
  std::array<RigParameters<double>, static_cast<std::size_t>(kLaneCount<T>)> lanes;
  Rig<T> rig;
  for (std::size_t i = 0; i < lanes.size(); ++i) lanes[i] = make_rig_parameters(*specs[i]);
  rig.layout = make_rig_layout(specs, lanes.data(), kLaneCount<T>);
  rig.numbers = pack_lanes<RigParameters, T>(lanes.data());
  std::get<0>(rig.struts).add(0, rig.numbers.spring);
  const unsigned bits = rig.layout.strut_effects;
  if ((bits & kShapedDamper) == 0) std::get<1>(rig.struts).add(0, rig.numbers.damper);
  rig.effects.add(0, bits, rig.numbers.effects, rig.layout.damper_curve);
  std::array<RigForceMap, lanes.size()> maps;
  std::array<const RigForceMap*, lanes.size()> map_of_lane;
  for (std::size_t i = 0; i < lanes.size(); ++i) {
    maps[i] = make_rig_force_map(*specs[i]);
    map_of_lane[i] = &maps[i];
  }
  rig.effects.add_maps(map_of_lane.data(), [](int) { return T(0.0); });
  return rig;
}

}  // namespace strut
