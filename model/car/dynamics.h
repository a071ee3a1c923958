// Equations of motion of the car: 6 chassis, 4 corner and 4 spin accelerations.
//
// Each corner is a composite with one coordinate q; its kinetic energy relative to the chassis
// frame has coefficients that depend on q alone (CornerMotion). With v, w the chassis-axes
// velocity of the chassis origin and angular velocity, S, J the whole car's first moment and
// inertia about it, and h = I_s s the wheel momenta along their axes u,
//
// clang-format off
//   m dv/dt - S x dw/dt + sum S_q ddq  = F + m g - w x p - w x S_dot - sum S_qq dq^2
//   S x dv/dt + J dw/dt + sum b ddq    = M + S x g - S_dot x v - J_dot w - v x p - w x l
//                                        - sum (b_q dq^2 + h_dot u + h u_q dq)
//   S_q.dv/dt + b.dw/dt + a ddq        = Q + S_q.g - a_q dq^2 / 2 + v.(w x S_q) + w.J_q w / 2
//                                        + h u_q.w - h_dot (u.beta)
//   I_s ds/dt                          = moment about the axis = h_dot
// clang-format on
//
// with p, l linear and angular momentum and beta the upright's angular velocity per unit dq. The
// spin of a wheel measured in inertial space does not couple, so 14 accelerations need one 6 x 6
// solve; of a car that moves symmetrically the left corners and a 3 x 3 solve suffice (sides.h).
// Derivation and the link to the paper's equations (1)-(3): docs/theory.md.
#pragma once

#include "base/math/linalg.h"
#include "model/car/sides.h"
#include "model/car/state.h"
#include "model/car/vehicle.h"

namespace strut {

/// Intermediate results of the right-hand side, by the stage that computes them.
template <class T>
struct Workspace {
  // pose
  Mat3<T> rotation;  // chassis to world
  std::array<CornerMotion<T>, kCorners> motion;
  T closure_error;  // m, maximum over corners
  T travel_excess;  // m, maximum over corners of the distance beyond the travel; negative inside
  // tires
  std::array<WheelMotion<T>, kCorners> wheel;
  std::array<TireContact<T>, kCorners> contact;
  std::array<TireSlipState<T>, kCorners> slip;
  std::array<TireWrench<T>, kCorners> wrench;
  std::array<T, kCorners> spin_moment;  // N m, tire and drive
  std::array<T, kCorners> segment;      // road segment each wheel is on (input)
  // struts
  std::array<StrutForce<T>, kCorners> strut;
  std::array<T, StateIndex::kStrutCount> strut_decay;  // 1/s, decay rates of the struts' states
  // composite
  Vec3<T> moment, moment_rate;
  Sym3<T> inertia;
  // accelerations
  Vec3<T> acceleration, angular_acceleration;  // d/dt of the chassis-axes components
  std::array<T, kCorners> corner_acceleration;
  std::array<T, kCorners> spin_decay;  // 1/s, decay rate of spin against slip
};

/// Forces of the tires: a car at rest does not roll and has no in-plane tire forces.
enum class TireMode { kRolling, kFrictionless };

/// Height and slope of a road under a wheel center at world x.
template <class T>
RoadPoint<T> find_road(const VehicleLayout& layout, const Road<T>& road, const T& world_x,
                       int corner, const T& segment) {
  RoadPoint<T> point{T(0.0), T(0.0)};
  if (layout.on_bump[corner]) point = calc_road_point(road, world_x, segment);
  const RoughTracks<T>& rough = road.rough[corner % 2];
  if (rough.is_rough) add_roughness(rough, world_x - road.center, point.height, point.slope);
  return point;
}

/// The same of the vehicle's road; of a dual with the derivatives of the road itself.
template <class T>
RoadPoint<T> find_road(const Vehicle<T>& vehicle, const T& world_x, int corner,
                       const Workspace<T>& ws) {
  const T& segment = ws.segment[corner];
  RoadPoint<T> point = find_road(vehicle.layout, vehicle.road, world_x, corner, segment);
  if constexpr (HasDerivatives<T>) {
    for (std::size_t i = 0; vehicle.road_slopes && i < kDirectionCount<T>; ++i) {
      if (!(*vehicle.road_slopes)[i]) continue;
      const RoadNeighbors<Passive<T>>& along = *(*vehicle.road_slopes)[i];
      const auto find = [&](const Road<Passive<T>>& road) {
        return find_road(vehicle.layout, road, world_x.v, corner, segment.v);
      };
      const RoadPoint<Passive<T>> above = find(along.above), below = find(along.below);
      point.height.d[i] += (above.height - below.height) * along.inverse_distance;
      point.slope.d[i] += (above.slope - below.slope) * along.inverse_distance;
    }
  }
  return point;
}

/// A wheel's motion, in chassis axes.
template <class T>
WheelMotion<T> calc_wheel_motion(const T* x, int corner, const CornerMotion<T>& motion) {
  using I = StateIndex;
  const Vec3<T> v = get_vec3(x, I::kVelocity), w = get_vec3(x, I::kAngularVelocity);
  const T& rate = x[I::kCornerRate + corner];
  return {motion.center, v + cross(w, motion.center) + rate * motion.center_q, motion.axis,
          w + rate * motion.upright_rate, x[I::kSpin + corner]};
}

/// Decrease of the clearance by the run-out of two wheels [m].
template <class T>
Pair<T> calc_runout(const Vehicle<T>& vehicle, const T* x, WheelPair pair) {
  const auto calc = [&](int corner) {
    const WheelRunout<T>& runout = vehicle.numbers.runout[corner];
    return T(runout.amplitude * cos(x[StateIndex::kWheelAngle + corner] + runout.phase));
  };
  return {calc(pair.first), calc(pair.second)};
}

/// Springs of the tires of two wheels: one value for both where they are of one axle.
template <Sides S, class T>
decltype(auto) get_tires(const VehicleParameters<T>& numbers, WheelPair pair) {
  if constexpr (S == Sides::kBoth) {
    return (numbers.tire[axle_of(pair.first)]);
  } else {
    return join_pair(numbers.tire[axle_of(pair.first)], numbers.tire[axle_of(pair.second)]);
  }
}

/// Motion of two wheels and their contact with the road.
template <Sides S, class T>
TireContact<Pair<T>> update_contacts(const Vehicle<T>& vehicle, const T* x, WheelPair pair,
                                     Workspace<T>& ws) {
  const int wheel[2] = {pair.first, pair.second};
  const Vec3<T> position = get_vec3(x, StateIndex::kPosition);
  RoadPoint<T> road[2];
  Vec3<T> center[2];
  for (int i = 0; i < 2; ++i) {
    const int c = wheel[i];
    ws.wheel[c] = calc_wheel_motion(x, c, ws.motion[c]);
    center[i] = position + ws.rotation * ws.motion[c].center;
    road[i] = find_road(vehicle, center[i].x, c, ws);
  }
  const Pair<T> slope(road[0].slope, road[1].slope);
  Pair<T> clearance(center[0].z - road[0].height, center[1].z - road[1].height);
  if (vehicle.layout.has_runout) clearance = clearance - calc_runout(vehicle, x, pair);
  const Pair<T> normal_z = Pair<T>(1.0) / sqrt(Pair<T>(1.0) + slope * slope);
  // The road's normal (-slope, 0, 1) in chassis axes.
  const Vec3<T> forward{ws.rotation.x.x, ws.rotation.y.x, ws.rotation.z.x};
  const Vec3<T> up{ws.rotation.x.z, ws.rotation.y.z, ws.rotation.z.z};
  const Vec3<Pair<T>> normal{normal_z * (up.x - slope * forward.x),
                             normal_z * (up.y - slope * forward.y),
                             normal_z * (up.z - slope * forward.z)};
  const auto& tires = get_tires<S>(vehicle.numbers, pair);
  const TireContact<Pair<T>> contact = calc_tire_contact(
      tires, vehicle.layout.contact, vehicle.layout.progressive_tire,
      join_pair(ws.wheel[pair.first], ws.wheel[pair.second]), normal, normal_z, clearance);
  split_pair(contact, ws.contact[pair.first], ws.contact[pair.second]);
  if (!vehicle.layout.tire_curve) return contact;
  for (const int c : wheel) {
    TireContact<T>& own = ws.contact[c];
    own.unclamped_load += calc_curved_load(vehicle.numbers.tire[axle_of(c)],
                                           *vehicle.layout.tire_curve, own.deflection);
    own.load = max(own.unclamped_load, T(0.0));
  }
  return join_pair(ws.contact[pair.first], ws.contact[pair.second]);
}

/// Forces on two tires.
template <Sides S, class T>
void update_tires(const Vehicle<T>& vehicle, const T* x, TireMode mode, WheelPair pair,
                  const TireContact<Pair<T>>& contact, Workspace<T>& ws) {
  const int a = pair.first, b = pair.second;
  if (mode == TireMode::kFrictionless) {
    for (const int c : {a, b}) {
      ws.wrench[c] = {ws.contact[c].load * ws.contact[c].normal,
                      {T(0.0), T(0.0), T(0.0)},
                      T(0.0),
                      T(0.0),
                      T(0.0)};
    }
    return;
  }
  const VehicleParameters<T>& numbers = vehicle.numbers;
  const WheelMotion<Pair<T>> wheel = join_pair(ws.wheel[a], ws.wheel[b]);
  const TireSlipState<Pair<T>> slip =
      calc_tire_slip(vehicle.pacejka, get_tires<S>(numbers, pair), wheel, contact);
  Pair<T> kappa = slip.kappa, tan_alpha = slip.tan_alpha;
  if (vehicle.layout.relaxation) {
    kappa = {x[StateIndex::kKappa + a], x[StateIndex::kKappa + b]};
    tan_alpha = {x[StateIndex::kTanAlpha + a], x[StateIndex::kTanAlpha + b]};
  }
  const Pair<T> side(T(is_right(a) ? -1.0 : 1.0), T(is_right(b) ? -1.0 : 1.0));
  split_pair(calc_tire_wrench(vehicle.pacejka, vehicle.layout.tire_parts, wheel, contact, slip,
                              kappa, tan_alpha, side),
             ws.wrench[a], ws.wrench[b]);
  split_pair(slip, ws.slip[a], ws.slip[b]);
}

/// Minimum relaxation length [m]; relaxation lengths vanish with the load, for example when a tire
/// leaves the road.
inline constexpr double kMinRelaxation = 0.05;

/// First-order slip: length * d(slip)/dt = speed * (steady slip - slip).
template <Sides S, class T>
void add_relaxation(const Vehicle<T>& vehicle, const T* x, const Workspace<T>& ws, T* dx) {
  using I = StateIndex;
  for (int c = 0; c < kCorners; c += kCornerStride<S>) {
    const TireSlipState<T>& slip = ws.slip[c];
    const RelaxationLength<T> length = calc_relaxation_length(
        vehicle.pacejka, ws.contact[c].load, dot(ws.wheel[c].axis, ws.contact[c].normal));
    dx[I::kKappa + c] =
        slip.speed * (slip.kappa - x[I::kKappa + c]) / max(length.longitudinal, T(kMinRelaxation));
    dx[I::kTanAlpha + c] = slip.speed * (slip.tan_alpha - x[I::kTanAlpha + c]) /
                           max(length.lateral, T(kMinRelaxation));
  }
}

/// Composite first moment and inertia of the whole car about the chassis origin.
template <Sides S, class T>
void update_composite(const Vehicle<T>& vehicle, const T* x, Workspace<T>& ws) {
  const RigidBody<T>& chassis = vehicle.numbers.chassis;
  ws.moment = chassis.mass * chassis.center;
  ws.inertia =
      chassis.inertia + T(0.5) * chassis.mass * inertia_form(chassis.center, chassis.center);
  ws.moment_rate = {T(0.0), T(0.0), T(0.0)};
  for (int c = 0; c < kCorners; c += kCornerStride<S>) {
    ws.moment += add_polar_sides<S>(ws.motion[c].moment);
    ws.inertia += add_sides<S>(ws.motion[c].inertia);
    ws.moment_rate += add_polar_sides<S>(x[StateIndex::kCornerRate + c] * ws.motion[c].moment_q);
  }
}

/// Force and moment about the chassis origin; one generalized force per corner.
template <class T>
struct GeneralizedForce {
  Vec3<T> force, moment;
  std::array<T, kCorners> corner;
};

/// Aerodynamic lift of both axles on the chassis, upwards through the axles' wheel centers; returns
/// its power [W].
template <class T>
T add_lift(const Vehicle<T>& vehicle, const Vec3<T>& v, const Vec3<T>& w, Vec3<T>& force,
           Vec3<T>& moment) {
  T power = T(0.0);
  for (int axle = 0; axle < kAxles; ++axle) {
    const T lift = vehicle.numbers.lift[axle] * v.x * v.x;
    const T& place = vehicle.numbers.geometry[2 * axle].wheel_center.x;
    force.z += lift;
    moment.y -= place * lift;
    power += lift * (v.z - place * w.y);
  }
  return power;
}

/// External and inertia forces: the right-hand sides of the equations at the top of this file.
/// Returns the power of non-conservative forces [W].
template <Sides S = Sides::kBoth, class T>
T calc_forces(const Vehicle<T>& vehicle, const T* x, Workspace<T>& ws, GeneralizedForce<T>& rhs) {
  using I = StateIndex;
  const Vec3<T> v = get_vec3(x, I::kVelocity), w = get_vec3(x, I::kAngularVelocity);
  const Vec3<T> gravity =
      transpose_times(ws.rotation, Vec3<T>{T(0.0), T(0.0), -vehicle.numbers.gravity});

  const Vec3<T> p = vehicle.numbers.mass * v + cross(w, ws.moment) + ws.moment_rate;
  Vec3<T> l = cross(ws.moment, v) + ws.inertia * w;
  Vec3<T> force = vehicle.numbers.mass * gravity - cross(w, ws.moment_rate);
  Vec3<T> moment = cross(ws.moment, gravity) - cross(ws.moment_rate, v) - cross(v, p);
  T power = T(0.0);

  for (int c = 0; c < kCorners; c += kCornerStride<S>) {
    const CornerMotion<T>& m = ws.motion[c];
    const TireWrench<T>& tire = ws.wrench[c];
    const T& rate = x[I::kCornerRate + c];
    const T& spin = x[I::kSpin + c];
    const T momentum = vehicle.numbers.inertia[c].spin_inertia * spin;
    const T rate2 = rate * rate;
    const Vec3<T> inertia_w = m.inertia_q * w;
    l += add_axial_sides<S>(rate * m.coupling + momentum * m.axis);

    const Vec3<T> contact_point = m.center + ws.contact[c].arm;
    const Vec3<T> arm_moment = cross(ws.contact[c].arm, tire.force) + tire.moment;
    const T tire_spin_moment = dot(arm_moment, m.axis);
    // The drive torque acts on the wheel and, as reaction, on the chassis, but not on the upright.
    const T& drive = vehicle.numbers.drive_torque[c];
    const T reaction = vehicle.numbers.drive_reaction * drive;
    ws.spin_moment[c] = tire_spin_moment + drive;

    force += add_polar_sides<S>(tire.force - rate2 * m.moment_qq);
    moment += add_axial_sides<S>(cross(contact_point, tire.force) + tire.moment -
                                 (tire_spin_moment + reaction) * m.axis - rate * inertia_w -
                                 rate2 * m.coupling_q - (momentum * rate) * m.axis_q);
    const T upright_spin = dot(m.axis, m.upright_rate);
    const T tire_on_corner = dot(tire.force, m.center_q) + dot(arm_moment, m.upright_rate);
    rhs.corner[c] = tire_on_corner - tire_spin_moment * upright_spin + ws.strut[c].generalized +
                    dot(m.moment_q, gravity + cross(v, w)) - T(0.5) * m.mass_q * rate2 +
                    T(0.5) * dot(w, inertia_w) + momentum * dot(m.axis_q, w);

    const T relative_spin = spin - upright_spin * rate - dot(m.axis, w);
    power += add_sides<S>(T(ws.strut[c].power + dot(tire.force, v) +
                            dot(cross(contact_point, tire.force), w) + dot(tire.moment, w) +
                            tire_on_corner * rate + tire_spin_moment * relative_spin +
                            drive * spin - reaction * dot(m.axis, w)));
  }
  if (vehicle.layout.has_lift) power += add_lift(vehicle, v, w, force, moment);
  rhs.force = force - cross(w, p);
  rhs.moment = moment - cross(w, l);
  return power;
}

/// The system of the chassis' accelerations: x, y, z and about x, y, z.
template <Sides S>
struct ChassisSystem {
  static constexpr std::size_t kSize = 6;
  template <class T>
  static std::array<T, kSize> gather(const Vec3<T>& linear, const Vec3<T>& angular) {
    return {linear.x, linear.y, linear.z, angular.x, angular.y, angular.z};
  }
  template <class T>
  static void scatter(const std::array<T, kSize>& a, Vec3<T>& linear, Vec3<T>& angular) {
    linear = {a[0], a[1], a[2]};
    angular = {a[3], a[4], a[5]};
  }
  template <class T>
  static SymmetricMatrix<T, kSize> make_inertia(const T& mass, const Workspace<T>& ws) {
    return make_spatial_inertia(mass, ws.moment, ws.inertia);
  }
};

/// The same for a symmetric motion, whose accelerations are along x and z and about y.
template <>
struct ChassisSystem<Sides::kLeft> {
  static constexpr std::size_t kSize = 3;
  template <class T>
  static std::array<T, kSize> gather(const Vec3<T>& linear, const Vec3<T>& angular) {
    return {linear.x, linear.z, angular.y};
  }
  template <class T>
  static void scatter(const std::array<T, kSize>& a, Vec3<T>& linear, Vec3<T>& angular) {
    linear = {a[0], T(0.0), a[1]};
    angular = {T(0.0), a[2], T(0.0)};
  }
  template <class T>
  static SymmetricMatrix<T, kSize> make_inertia(const T& mass, const Workspace<T>& ws) {
    return make_planar_inertia(mass, ws.moment, ws.inertia);
  }
};

/// Eliminates the corner accelerations, solves the chassis block, substitutes back.
template <Sides S, class T>
void solve_accelerations(const Vehicle<T>& vehicle, const GeneralizedForce<T>& rhs,
                         Workspace<T>& ws) {
  using Chassis = ChassisSystem<S>;
  auto a = Chassis::make_inertia(vehicle.numbers.mass, ws);
  auto b = Chassis::gather(rhs.force, rhs.moment);
  std::array<std::array<T, Chassis::kSize>, kCorners> coupling;
  std::array<T, kCorners> inverse;
  for (int c = 0; c < kCorners; c += kCornerStride<S>) {
    const CornerMotion<T>& m = ws.motion[c];
    coupling[c] = Chassis::gather(m.moment_q, m.coupling);
    inverse[c] = T(1.0) / m.mass;
    add_rank_one(a, coupling[c], add_sides<S>(T(-inverse[c])));
    const T scaled = add_sides<S>(T(rhs.corner[c] * inverse[c]));
    for (std::size_t i = 0; i < b.size(); ++i) b[i] -= coupling[c][i] * scaled;
  }
  solve_ldlt(a, b);
  Chassis::scatter(b, ws.acceleration, ws.angular_acceleration);
  for (int c = 0; c < kCorners; c += kCornerStride<S>) {
    T r = rhs.corner[c];
    for (std::size_t i = 0; i < b.size(); ++i) r -= coupling[c][i] * b[i];
    ws.corner_acceleration[c] = r * inverse[c];
  }
}

/// Rates of position, orientation and wheel angles.
template <Sides S, class T>
void update_kinematic_rates(const T* x, const Workspace<T>& ws, T* dx) {
  using I = StateIndex;
  const Vec3<T> v = get_vec3(x, I::kVelocity), w = get_vec3(x, I::kAngularVelocity);
  set_vec3(dx, I::kPosition, ws.rotation * v);
  const Quaternion<T> e = get_quaternion(x);
  // This term vanishes at unit length and bounds the drift of the length due to integration errors.
  const T pull = T(1.0) - (e.w * e.w + e.x * e.x + e.y * e.y + e.z * e.z);
  dx[I::kQuaternion] = T(-0.5) * (e.x * w.x + e.y * w.y + e.z * w.z) + pull * e.w;
  dx[I::kQuaternion + 1] = T(0.5) * (e.w * w.x + e.y * w.z - e.z * w.y) + pull * e.x;
  dx[I::kQuaternion + 2] = T(0.5) * (e.w * w.y + e.z * w.x - e.x * w.z) + pull * e.y;
  dx[I::kQuaternion + 3] = T(0.5) * (e.w * w.z + e.x * w.y - e.y * w.x) + pull * e.z;
  for (int c = 0; c < kCorners; c += kCornerStride<S>) {
    const CornerMotion<T>& m = ws.motion[c];
    const T& rate = x[I::kCornerRate + c];
    dx[I::kCorner + c] = rate;
    dx[I::kWheelAngle + c] = x[I::kSpin + c] - dot(m.axis, m.upright_rate) * rate - dot(m.axis, w);
  }
}

/// Adds the forces of effects to the linear forces of the struts, and computes the rates of the
/// effects' states, if there are any.
template <class T>
void update_strut_effects(const Vehicle<T>& vehicle, const T* x, T* dx, Workspace<T>& ws) {
  using I = StateIndex;
  StrutStates<T> states;
  if (vehicle.effects.has_states()) {
    states = {x + I::kStrut, dx + I::kStrut, ws.strut_decay.data()};
    for (int i = I::kKappa; !vehicle.layout.relaxation && i < I::kStrut; ++i) dx[i] = T(0.0);
  }
  add_strut_effects<T, kCorners>(vehicle.effects, ws.motion, x + I::kCornerRate, T(0.0), states,
                                 ws.strut);
}

/// dx/dt of the car at state x. `closure(corner, q, motion)` computes the corner's motion functions
/// and returns the residual loop error [m] (closures.h). ws.segment is input, the rest of ws
/// output. With Sides::kLeft `x` is a symmetric motion of a car that is its own mirror image, and
/// what belongs to the right side is neither read nor written.
template <Sides S = Sides::kBoth, class T, class Closure>
void calc_derivative(const Vehicle<T>& vehicle, const Closure& closure, TireMode mode, const T* x,
                     T* dx, Workspace<T>& ws) {
  using I = StateIndex;
  ws.rotation = rotation_of(get_quaternion(x));
  ws.closure_error = T(0.0);
  ws.travel_excess = T(-1.0);
  for (int c = 0; c < kCorners; c += kCornerStride<S>) {
    const T& q = x[I::kCorner + c];
    ws.closure_error = max(ws.closure_error, closure(c, q, ws.motion[c]));
    ws.travel_excess = max(ws.travel_excess, abs(q) - T(vehicle.layout.predictor[c].half_travel));
  }
  for (int i = 0; i < kWheelPairs<S>; ++i) {
    const WheelPair pair = get_wheel_pair<S>(i);
    update_tires<S>(vehicle, x, mode, pair, update_contacts<S>(vehicle, x, pair, ws), ws);
  }
  add_strut_forces<T, kCorners>(vehicle.struts, ws.motion, x + I::kCornerRate, ws.strut);
  if (vehicle.effects.count > 0) update_strut_effects(vehicle, x, dx, ws);
  update_composite<S>(vehicle, x, ws);
  GeneralizedForce<T> rhs;
  const T power = calc_forces<S>(vehicle, x, ws, rhs);
  solve_accelerations<S>(vehicle, rhs, ws);

  update_kinematic_rates<S>(x, ws, dx);
  set_vec3(dx, I::kVelocity, ws.acceleration);
  set_vec3(dx, I::kAngularVelocity, ws.angular_acceleration);
  for (int c = 0; c < kCorners; c += kCornerStride<S>) {
    const T inverse = T(1.0) / vehicle.numbers.inertia[c].spin_inertia;
    dx[I::kCornerRate + c] = ws.corner_acceleration[c];
    dx[I::kSpin + c] = ws.spin_moment[c] * inverse;
    ws.spin_decay[c] = vehicle.layout.relaxation ? T(0.0) : ws.wrench[c].spin_damping * inverse;
  }
  dx[I::kWork] = power;
  if (vehicle.layout.relaxation) add_relaxation<S>(vehicle, x, ws, dx);
}

/// Kinetic energy, potential energy of gravity (zero at world z = 0) and of springs [J].
template <class T>
T calc_energy(const Vehicle<T>& vehicle, const T* x, const Workspace<T>& ws) {
  using I = StateIndex;
  const Vec3<T> v = get_vec3(x, I::kVelocity), w = get_vec3(x, I::kAngularVelocity);
  const Vec3<T> world_moment = ws.rotation * ws.moment;
  T energy =
      T(0.5) * vehicle.numbers.mass * dot(v, v) + dot(v, cross(w, ws.moment)) +
      T(0.5) * dot(w, ws.inertia * w) +
      vehicle.numbers.gravity * (vehicle.numbers.mass * x[I::kPosition + 2] + world_moment.z);
  for (int c = 0; c < kCorners; ++c) {
    const CornerMotion<T>& m = ws.motion[c];
    const T& rate = x[I::kCornerRate + c];
    const T& spin = x[I::kSpin + c];
    energy += rate * (dot(v, m.moment_q) + dot(w, m.coupling)) + T(0.5) * m.mass * rate * rate +
              T(0.5) * vehicle.numbers.inertia[c].spin_inertia * spin * spin + ws.strut[c].energy;
  }
  return energy;
}

}  // namespace strut
