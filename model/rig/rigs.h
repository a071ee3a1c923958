// Test stands from the car's force elements: quarter car, strut on a dynamometer, single mass.
//
// Positions are displacements from the rest position, up positive: the static equilibrium under
// gravity at road position zero (masses), the point at which the spring is relaxed (strut_rig,
// whose displacement is positive in compression). Forces are total, the static load included. Force
// of strut and actuator is positive where it pushes its two ends apart. So with gravity = 0, and
// for every rig whose tire cannot lift off, motion is that of the deviations from rest.
//
//   quarter_car  m_u a_u = F_t - F_s - F_a - m_u g,   m_s a_s = F_s + F_a - m_s g
//   single_mass  m a = F + F_s - m g
//   strut_rig    F = F_s at the given displacement and its rate
//
// F_s: sum of the strut's elements, F_t: tire, F_a: actuator force, F: applied force.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "model/channel/rig_channels.h"
#include "model/effects/force_map.h"
#include "model/force/strut_effects.h"
#include "model/force/tire_contact.h"
#include "model/scenario/input_signal.h"

namespace strut {

/// Names of the kinds in RigKind order: the `type` of a rig's file.
const std::vector<std::string>& list_rig_kinds();

inline constexpr int kRigCoordinates = 2;
/// Coordinates; single_mass has only the first.
enum RigCoordinate : int { kUnsprung = 0, kSprung = 1 };

struct RigSpec {
  RigKind kind = RigKind::kQuarterCar;
  std::string name;
  double sprung_mass = 0.0;      // kg; single_mass: the mass
  double unsprung_mass = 0.0;    // kg
  double stiffness = 0.0;        // N/m, strut; single_mass: 0 for none
  double damping = 0.0;          // N s/m, strut
  double tire_stiffness = 0.0;   // N/m
  double tire_damping = 0.0;     // N s/m
  double gravity = 0.0;          // m/s^2, along the guide
  double temperature = 293.15;   // K, where no input gives it
  bool unilateral_tire = false;  // true: the car's tire law, which lifts off
  /// Start, as an offset from rest on the road's first position [m], [m/s]; by RigCoordinate.
  std::array<double, kRigCoordinates> initial_position{}, initial_velocity{};
  EffectSettings effects;
  ForceMaps force_maps;  // at most one; what it gives at rest the spring need not carry
  bool operator==(const RigSpec&) const = default;
};

/// A number of a rig that files, settings and fits know by name.
struct RigParameterInfo {
  std::string name, unit, description;
  double low, high;  // allowed
  bool open_low;     // `low` itself is not allowed
  std::optional<double> fallback;
  double RigSpec::*field;
};

/// The parameters of a kind of rig, each listed once; readers and help texts derive from it.
const std::vector<RigParameterInfo>& list_rig_parameters(RigKind kind);

/// Throws ModelError with name, value and allowed range.
void validate(const RigSpec& spec);

struct RigInputInfo {
  std::string name, unit, description;
  bool required;
};

inline constexpr int kMaxRigInputs = 2;
/// What can drive a kind of rig, in the order of RigSystem's signals.
const std::vector<RigInputInfo>& list_rig_inputs(RigKind kind);

/// What drives a rig and for how long.
struct RigManeuver {
  double duration = 0.0;  // s
  std::vector<InputSignal> inputs;
};

/// The signals in the order of list_rig_inputs, null where none is given. Throws ModelError for an
/// input that this kind of rig does not have, one that is given twice and one that is missing.
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
  T static_deflection;  // m, of the tire at rest
  T road_gain;          // of the road's input
  T gravity;            // m/s^2
  T temperature;        // K
};

/// What is common to all simulations of a batch.
struct RigLayout {
  RigKind kind = RigKind::kQuarterCar;
  bool unilateral_tire = false;
  unsigned strut_effects = 0;  // StrutEffectBits
  bool progressive_tire = false;
};

template <class T>
struct Rig {
  RigLayout layout;
  RigParameters<T> numbers;
  StrutElements<T> struts;
  StrutEffects<T> effects{};
};

/// The kind of model that a kind of rig is to the catalogue of effects.
ModelKind get_model_kind(RigKind kind);

/// Numbers of a rig at its rest position. Throws ModelError as validate does.
RigParameters<double> make_rig_parameters(const RigSpec& spec);

/// Layout of rigs that may share lanes. Throws ModelError where kind or tire contact differ.
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
  rig.effects.add(0, bits, rig.numbers.effects);
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
