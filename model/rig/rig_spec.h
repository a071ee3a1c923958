// Specification of a test stand made of the car's force elements, and of the inputs that drive it.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "model/effects/force_map.h"
#include "model/effects/setting.h"
#include "model/force/force_curve.h"
#include "model/scenario/input_signal.h"

namespace strut {

enum class RigKind { kQuarterCar, kStrutRig, kSingleMass, kGuidedMass };

inline constexpr int kRigCoordinates = 2;
/// Coordinates of a quarter car; a rig with one mass has only the first.
enum RigCoordinate : int { kUnsprung = 0, kSprung = 1 };

struct RigSpec {
  RigKind kind = RigKind::kQuarterCar;
  std::string name;
  double sprung_mass = 0.0;              // kg; the only mass of a rig with one mass
  double unsprung_mass = 0.0;            // kg
  double stiffness = 0.0;                // N/m, strut; 0: no spring, where a rig allows it
  double damping = 0.0;                  // N s/m, strut
  double tire_stiffness = 0.0;           // N/m
  double tire_damping = 0.0;             // N s/m
  double guide_friction = 0.0;           // N, between the (sprung) mass and its guide on the ground
  double unsprung_guide_friction = 0.0;  // N
  double guide_asymmetry = 0.0;          // friction (1 + a) upwards, (1 - a) downwards
  double guide_speed = 0.01;             // m/s, at which 76 % of the friction acts
  double guide_stroke = 0.0;             // m, over which it builds up; 0: at once
  double moving_mass = 0.0;              // kg, moved by a stand between its load cell and the strut
  double deflection_feedback = 0.0;      // N/m, of the force between the masses by their states
  double sprung_velocity_feedback = 0.0;    // N s/m
  double tire_deflection_feedback = 0.0;    // N/m
  double unsprung_velocity_feedback = 0.0;  // N s/m
  double gravity = 0.0;                     // m/s^2, along the guide
  double temperature = 293.15;              // K, without an input for it
  bool unilateral_tire = false;             // true: the car's tire law, which lifts off
  /// Initial state, as an offset from rest on the ground's first position [m], [m/s]; by
  /// RigCoordinate.
  std::array<double, kRigCoordinates> initial_position{}, initial_velocity{};
  ForceCurveSpec damper_curve;  // that `damping` scales; empty: a straight line
  ForceCurveSpec tire_curve;    // that `tire_stiffness` scales; empty: a straight line
  EffectSettings effects;
  ForceMaps force_maps;  // at most one; its force at rest reduces the load of the spring
  bool operator==(const RigSpec&) const = default;
};

/// The inputs of a rig and their duration.
struct RigManeuver {
  double duration = 0.0;  // s
  std::vector<InputSignal> inputs;
};

/// One rig under its inputs, the subject of one simulation.
struct RigCase {
  RigSpec rig;
  std::vector<InputSignal> inputs;
};

}  // namespace strut
