// One tire on the road: contact point, vertical spring-damper that lifts off, slips, PAC2002.
#pragma once

#include "base/math/spatial.h"
#include "model/force/force_curve.h"
#include "model/force/pac2002.h"
#include "model/scenario/road.h"

namespace strut {

/// Minimum divisor of slip velocities, which keeps the slip of a standing wheel finite [m/s].
inline constexpr double kSlipSpeedFloor = 0.5;
/// Deflection over which the tire's damping builds up, so that the force of a touchdown has no step
/// [m].
inline constexpr double kDampingRamp = 2e-3;

template <class T>
struct TireVertical {
  T radius;     // m, unloaded
  T stiffness;  // N/m
  T damping;    // N s/m
  /// 1/m, growth of the stiffness with the deflection; used by calc_progressive_load only.
  T progression;
};

/// Out-of-round wheel: its radius is larger by amplitude * cos(angle + phase) where it touches.
template <class T>
struct WheelRunout {
  T amplitude;  // m
  T phase;      // rad
};

/// Motion of a wheel, all vectors in one frame (chassis axes).
template <class T>
struct WheelMotion {
  Vec3<T> center;         // m
  Vec3<T> velocity;       // m/s, of the center
  Vec3<T> axis;           // unit, to the left
  Vec3<T> upright_omega;  // rad/s, of the upright
  T spin;                 // rad/s, wheel's angular velocity along the axis, in inertial space
};

/// Contact of a wheel with the plane of the effective road.
template <class T>
struct TireContact {
  Vec3<T> normal, forward, lateral;  // unit, contact frame
  Vec3<T> arm;                       // m, wheel center to contact point
  T loaded_radius;                   // m, in the wheel plane
  T deflection;                      // m, > 0 in contact
  T unclamped_load;                  // N, its sign is the contact event
  T load;                            // N
};

/// 6 t^5 - 15 t^4 + 10 t^3 on [0, 1], constant outside.
template <class T>
T smoothstep(const T& x) {
  const T t = min(max(x, T(0.0)), T(1.0));
  return t * t * t * (t * (t * T(6.0) - T(15.0)) + T(10.0));
}

/// k d + c r s(d / kDampingRamp), s = smoothstep: load [N] of a tire at deflection d [m] and rate r
/// [m/s] before clamping at zero. Its sign change is the contact event.
template <class C, class T>
T calc_unclamped_load(const TireVertical<C>& tire, const T& deflection, const T& rate) {
  return tire.stiffness * deflection +
         tire.damping * smoothstep(deflection * T(1.0 / kDampingRamp)) * rate;
}

/// k q d abs(d): load of a progressive tire in addition to that of the linear tire [N].
template <class C, class T>
T calc_progressive_load(const TireVertical<C>& tire, const T& deflection) {
  return (tire.stiffness * tire.progression) * (deflection * abs(deflection));
}

/// k d (L_0(d) / (k_0 d) - 1), L_0 the curve: load of a tire with a curve in addition to that of
/// the linear tire [N].
template <class C, class T>
T calc_curved_load(const TireVertical<C>& tire, const ForceCurve& curve, const T& deflection) {
  return tire.stiffness * deflection * (calc_rate_factor(curve, deflection) - T(1.0));
}

/// Deflection [m] at which the tire carries `load` >= 0 [N] at rest. `curve`: null for none.
/// Throws ModelError if there is none.
double calc_static_deflection(const TireVertical<double>& tire, const ForceCurve* curve,
                              double load);

/// Contact with the effective road under the wheel: `normal` of the road, its vertical component
/// `normal_z` in the world, and `clearance`, the height of the wheel center over the road [m].
/// Envelope: the road is the path of the center of a rolling rigid disc of the free radius, so the
/// deflection is the distance to that path along its normal. Point: the road is the plane itself.
/// `progressive`: adds calc_progressive_load.
template <class C, class T>
TireContact<T> calc_tire_contact(const TireVertical<C>& tire, ContactKind kind, bool progressive,
                                 const WheelMotion<T>& wheel, const Vec3<T>& normal,
                                 const T& normal_z, const T& clearance) {
  TireContact<T> contact;
  contact.normal = normal;
  const Vec3<T> sideways = cross(wheel.axis, normal);
  // Also 1/(up . normal), because up . normal = (forward x axis) . normal = forward . sideways.
  const T tilt = T(1.0) / norm(sideways);
  contact.forward = tilt * sideways;
  contact.lateral = cross(normal, contact.forward);
  const Vec3<T> up = cross(contact.forward, wheel.axis);  // in the wheel plane
  const T distance = kind == ContactKind::kEnvelope
                         ? tire.radius - (tire.radius - clearance) * normal_z
                         : clearance * normal_z;
  contact.loaded_radius = distance * tilt;
  contact.arm = -contact.loaded_radius * up;
  contact.deflection = tire.radius - contact.loaded_radius;
  const T rate = -dot(wheel.velocity, normal) * tilt;
  contact.unclamped_load = calc_unclamped_load(tire, contact.deflection, rate);
  if (progressive) contact.unclamped_load += calc_progressive_load(tire, contact.deflection);
  contact.load = max(contact.unclamped_load, T(0.0));
  return contact;
}

/// Slip velocities of a tire and its slips.
template <class T>
struct TireSlipState {
  T speed;           // m/s, >= kSlipSpeedFloor
  T forward, side;   // m/s: V_x of the center, V_y of the contact point on the upright
  T rolling_radius;  // m
  T kappa;           // 1
  T tan_alpha;       // 1
};

template <class C, class Tire, class T>
TireSlipState<T> calc_tire_slip(const Pac2002<C>& pacejka, const TireVertical<Tire>& tire,
                                const WheelMotion<T>& wheel, const TireContact<T>& contact) {
  TireSlipState<T> slip;
  slip.forward = dot(wheel.velocity, contact.forward);
  slip.side = dot(wheel.velocity + cross(wheel.upright_omega, contact.arm), contact.lateral);
  slip.speed = max(abs(slip.forward), T(kSlipSpeedFloor));
  slip.rolling_radius =
      calc_rolling_radius(pacejka, tire.radius, contact.deflection, tire.stiffness);
  const T inverse = T(1.0) / slip.speed;
  slip.kappa = (wheel.spin * slip.rolling_radius - slip.forward) * inverse;
  slip.tan_alpha = slip.side * inverse;
  return slip;
}

/// Force and moment at the contact point, in the frame of the wheel's vectors.
template <class T>
struct TireWrench {
  Vec3<T> force;   // N
  Vec3<T> moment;  // N m
  T fx, fy;        // N, in the contact frame
  T spin_damping;  // N m s/rad, -d(moment about the axis)/d(spin) at free rolling
};

/// `kappa`, `tan_alpha`: slips of the force law, steady or relaxed. `side`: +1 left, -1 right.
template <class C, class T>
TireWrench<T> calc_tire_wrench(const Pac2002<C>& pacejka, const Pac2002Parts& parts,
                               const WheelMotion<T>& wheel, const TireContact<T>& contact,
                               const TireSlipState<T>& slip, const T& kappa, const T& tan_alpha,
                               const T& side) {
  const TireSlip<T> input{contact.load, kappa, atan_any(tan_alpha), dot(wheel.axis, contact.normal),
                          slip.forward};
  const TireForce<T> f = calc_tire_force(pacejka, input, side, parts);
  TireWrench<T> wrench;
  wrench.fx = f.fx;
  wrench.fy = f.fy;
  wrench.force = f.fx * contact.forward + f.fy * contact.lateral + contact.load * contact.normal;
  wrench.moment = f.mx * contact.forward + f.my * contact.lateral + f.mz * contact.normal;
  wrench.spin_damping = f.slip_stiffness * slip.rolling_radius * contact.loaded_radius / slip.speed;
  return wrench;
}

}  // namespace strut
