// The car in the form of the equations of motion: topology common to a batch, parameters per
// simulation.
#pragma once

#include "base/math/dual.h"
#include "model/car/spec.h"
#include "model/force/strut_effects.h"
#include "model/force/tire_contact.h"
#include "model/multibody/closure.h"
#include "model/multibody/corner.h"

namespace strut {

/// Parameters of one car and maneuver: fields of T only, so that W of them pack into lanes.
template <class T>
struct VehicleParameters {
  T mass;                // kg, whole car
  RigidBody<T> chassis;  // about the chassis origin's axes
  std::array<CornerGeometry<T>, kCorners> geometry;
  std::array<CornerInertia<T>, kCorners> inertia;
  std::array<LinearSpring<T>, kCorners> spring;
  std::array<LinearDamper<T>, kCorners> damper;
  std::array<StrutEffectNumbers<T>, kCorners> effects;
  std::array<AntiRollBar<T>, kAxles> anti_roll_bar;
  std::array<T, kCorners> drive_torque;             // N m, on each wheel
  T drive_reaction;                                 // fraction of them that the chassis reacts
  std::array<T, kLines * kCorners> nominal_length;  // m, lines at nominal trim
  std::array<TireVertical<T>, kAxles> tire;
  std::array<WheelRunout<T>, kCorners> runout;
  std::array<T, kAxles> lift;  // N s^2/m^2, aerodynamic lift over speed squared
  Vec3<T> imu;                 // m, chassis axes
  T gravity;                   // m/s^2
};

template <class C>
using VehiclePredictors = std::array<ClosurePredictor<C>, kCorners>;

/// The properties common to all simulations of a batch.
struct VehicleLayout {
  std::array<CornerTopology, kCorners> corner;
  VehiclePredictors<double> predictor;
  ContactKind contact = ContactKind::kEnvelope;
  bool relaxation = false;
  Pac2002Parts tire_parts;
  std::array<bool, kCorners> on_bump{true, true, true, true};  // wheels that see the bump
  std::array<unsigned, kCorners> strut_effects{};              // StrutEffectBits
  std::array<std::shared_ptr<const ForceCurve>, kAxles> damper_curve{};
  std::shared_ptr<const ForceCurve> tire_curve{};
  std::array<bool, kAxles> has_anti_roll_bar{};
  bool progressive_tire = false, has_runout = false, has_lift = false;
};

/// Force maps of the corners; null where there is none.
using CornerForceMaps = std::array<std::shared_ptr<const ForceMapTable>, kCorners>;

template <class T>
struct Vehicle {
  VehicleLayout layout;
  VehicleParameters<T> numbers;
  Pac2002<Passive<T>> pacejka;
  StrutElements<T> struts;
  Road<T> road;
  StrutEffects<T> effects{};
  std::shared_ptr<const RoadSlopes<Passive<T>, kDirectionCount<T>>> road_slopes{};  // of duals only
};

}  // namespace strut
