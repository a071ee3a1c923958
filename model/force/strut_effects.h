// Force elements of the catalogue's effects (model/effects) in a strut. An effect that is off is
// not in any list; without effects none of these functions is called.
//
// d = nominal length - length and v = -d(length)/dt are deflection and speed in compression.
#pragma once

#include "model/force/damper_law.h"
#include "model/force/force_curve.h"
#include "model/force/force_map.h"

namespace strut {

/// F = k q d^3, in addition to the LinearSpring.
template <class T>
struct CubicSpring {
  static constexpr Line kLine = kSpringLine;
  static constexpr bool kConservative = true;
  T rate;            // k q, N/m^3
  T nominal_length;  // m

  T calc_force(const LineState<T>& line) const {
    const T d = nominal_length - line.length;
    return rate * (d * d * d);
  }
  T calc_energy(const LineState<T>& line) const {
    return T(0.25) * rate * square(square(nominal_length - line.length));
  }
};

/// F = k_b (s + p s^2), s = max(d - g, 0).
template <class T>
struct BumpStop {
  static constexpr Line kLine = kSpringLine;
  static constexpr bool kConservative = true;
  T stiffness;       // k_b, N/m
  T progression;     // p, 1/m
  T contact_length;  // m, nominal length - g

  T calc_force(const LineState<T>& line) const {
    const T s = max(contact_length - line.length, T(0.0));
    return stiffness * s * (T(1.0) + progression * s);
  }
  T calc_energy(const LineState<T>& line) const {
    const T s = max(contact_length - line.length, T(0.0));
    return stiffness * square(s) * (T(0.5) + T(1.0 / 3.0) * progression * s);
  }
};

/// tanh(x); absolute error: one unit in the last place of 1.
template <class T>
T calc_tanh(const T& x) {
  const T e = exp(T(-2.0) * abs(x));
  const T size = (T(1.0) - e) / (T(1.0) + e);
  return select(x < T(0.0), -size, size);
}

/// F = F_c tanh(v / v_s); with a flank b > 0 behind a play p the law of calc_elastic_friction.
template <class T>
struct DryFriction {
  static constexpr Line kLine = kDamperLine;
  static constexpr bool kConservative = false;
  T force;          // F_c, N
  T inverse_speed;  // 1 / v_s, s/m
  T stroke{0.0};    // b, m
  T play{0.0};      // p, m, where there is a flank

  T calc_force(const T& speed) const { return force * calc_tanh(speed * inverse_speed); }
  T calc_force(const LineState<T>& line) const { return calc_force(-line.rate); }
  T calc_energy(const LineState<T>&) const { return T(0.0); }
};

/// State s [m] of a DryFriction with a flank, its time derivative, and its decay rate [1/s].
template <class T>
struct FrictionState {
  T value, rate, decay;
};

/// Friction with an elastic flank and a play before it, of relative size z [1]:
///
///   z = (s - clamp(s, -p / 2, p / 2)) / b,   ds/dt = v - z v / tanh(v / v_s)
///
/// s is the displacement of play and flank. Sliding steadily, z is tanh(v / v_s), the law without a
/// flank, which the limit b = 0 is; after a reversal the force falls along the flank of stiffness
/// F_c / b, is 0 over the play, and rises along the flank, exponentially: 1 - z falls by e over b.
/// At rest it keeps its force but for a creep of v_s. P. R. Dahl, A Solid Friction Model, Aerospace
/// Corporation TOR-0158(3107-18)-1, 1968, for p = 0. F_c z v is at least the growth of the energy
/// F_c b z^2 / 2.
template <class T>
T calc_elastic_friction(const DryFriction<T>& friction, const T& speed, FrictionState<T>& state) {
  constexpr double kSmall = 1e-4;  // v / v_s, below which tanh is its argument
  const auto has_flank = friction.stroke > T(0.0);
  const T stroke = select(has_flank, friction.stroke, T(1.0));
  const T relative = speed * friction.inverse_speed;
  const auto small = abs(relative) < T(kSmall);
  const T slope = select(small, T(1.0) / friction.inverse_speed,
                         speed / select(small, T(1.0), calc_tanh(relative)));
  const T half = T(0.5) * friction.play;
  const T z = (state.value - min(max(state.value, -half), half)) / stroke;
  state.rate = select(has_flank, speed - z * slope, T(0.0));
  state.decay = select(has_flank, slope / stroke, T(0.0));
  return friction.force * z;
}

/// calc_elastic_friction at `speed` in lanes with a flank, elsewhere calc_force at `rigid_speed`;
/// leaves `state` as it is where no lane has a flank.
template <class T>
T calc_friction(const DryFriction<T>& friction, const T& rigid_speed, const T& speed,
                FrictionState<T>& state) {
  const T rigid = friction.calc_force(rigid_speed);
  const auto has_flank = friction.stroke > T(0.0);
  if (!any(has_flank)) return rigid;
  return select(has_flank, calc_elastic_friction(friction, speed, state), rigid);
}

/// State s of a flank after a long motion at constant speed [m].
template <class T>
T calc_settled_friction(const DryFriction<T>& friction, const T& speed) {
  const T side = select(speed > T(0.0), T(0.5), select(speed < T(0.0), T(-0.5), T(0.0)));
  const T settled =
      friction.play * side + friction.stroke * calc_tanh(speed * friction.inverse_speed);
  return select(friction.stroke > T(0.0), settled, T(0.0));
}

/// F = F_g.
template <class T>
struct GasForce {
  static constexpr Line kLine = kDamperLine;
  static constexpr bool kConservative = true;
  T force;  // F_g, N

  T calc_force(const LineState<T>&) const { return force; }
  T calc_energy(const LineState<T>& line) const { return -force * line.length; }
};

/// Force on both springs' lines of an axle by the difference of their deflections.
template <class T>
struct AntiRollBar {
  T stiffness;      // N/m
  T nominal_twist;  // m, nominal length left - right
};

/// Parameters of all effects of one strut; neutral for those that are off.
template <class T>
struct StrutEffectNumbers {
  DamperLaw<T> law;
  DamperSeries<T> series;
  CubicSpring<T> spring;
  BumpStop<T> stop;
  DryFriction<T> friction;
  GasForce<T> gas;
};

/// The elements of a strut other than spring and damper; bits of a set, common to a batch.
enum StrutEffectBits : unsigned {
  kShapedDamper = 1,  // instead of the linear damper
  kSeriesDamper = 2,  // a shaped damper with states, of its own or of its friction
  kCubicSpring = 4,
  kBumpStop = 8,
  kDryFriction = 16,
  kGasForce = 32,
};

inline constexpr int kStatesPerStrut = 4;  // three of a DamperSeries, one of a DryFriction

template <class T>
struct ShapedDamper {
  DamperLaw<T> law;
  DamperSeries<T> series;
  /// Beside a damper with states, at the strut's speed v; without a flank, behind a worn joint at
  /// the damper's w.
  DryFriction<T> friction;
  bool has_friction = false;
  const ForceCurve* curve = nullptr;  // that the law's rate scales; null: a straight line

  /// F / v [N s/m], as DamperLaw.
  T calc_rate(const T& speed, const T& warming) const {
    const T rate = law.calc_rate(speed, warming);
    return curve == nullptr ? rate : rate * calc_rate_factor(*curve, speed);
  }
};

template <class T>
struct StrutEffects {
  ElementList<ShapedDamper<T>> shaped, series;
  std::tuple<ElementList<CubicSpring<T>>, ElementList<BumpStop<T>>, ElementList<DryFriction<T>>,
             ElementList<GasForce<T>>, ElementList<MappedForce<T>>>
      added;
  ElementList<AntiRollBar<T>> bars;                               // at the axle's left corner
  int count = 0;                                                  // elements of all lists
  std::shared_ptr<const std::vector<double>> map_coefficients{};  // those of the mapped forces
  std::array<std::shared_ptr<const ForceCurve>, kMaxElements> curves{};  // by corner

  bool has_states() const { return series.count > 0; }

  /// `curve`: of the damper, common to all lanes; null: none.
  void add(int corner, unsigned bits, const StrutEffectNumbers<T>& numbers,
           const std::shared_ptr<const ForceCurve>& curve) {
    curves[static_cast<std::size_t>(corner)] = curve;
    const auto add_if = [&](unsigned bit, auto& list, const auto& element) {
      if ((bits & bit) == 0) return;
      list.add(corner, element);
      ++count;
    };
    const bool has_friction = (bits & kSeriesDamper) != 0 && (bits & kDryFriction) != 0;
    const ShapedDamper<T> damper{numbers.law, numbers.series, numbers.friction, has_friction,
                                 curve.get()};
    add_if(kSeriesDamper, series, damper);
    if ((bits & kSeriesDamper) == 0) add_if(kShapedDamper, shaped, damper);
    add_if(kCubicSpring, std::get<0>(added), numbers.spring);
    add_if(kBumpStop, std::get<1>(added), numbers.stop);
    if (!has_friction) add_if(kDryFriction, std::get<2>(added), numbers.friction);
    add_if(kGasForce, std::get<3>(added), numbers.gas);
  }
  void add_bar(int left_corner, const AntiRollBar<T>& bar) {
    bars.add(left_corner, bar);
    ++count;
  }

  /// Adds the maps `tables[lane][corner]` (null: none) of every `stride`-th corner.
  /// `get_length(corner)`: length of the damper's line at nominal trim [m].
  template <class Tables, class GetLength>
  void add_maps(const Tables* const* tables, const GetLength& get_length, std::size_t stride = 1) {
    auto& list = std::get<4>(added);
    ForceMapPacker packer;
    for (std::size_t c = 0; c < std::tuple_size_v<Tables>; c += stride) {
      std::array<const ForceMapTable*, static_cast<std::size_t>(kLaneCount<T>)> lanes;
      for (std::size_t lane = 0; lane < lanes.size(); ++lane)
        lanes[lane] = (*tables[lane])[c].get();
      if (std::all_of(lanes.begin(), lanes.end(), [](const auto* t) { return t == nullptr; })) {
        continue;
      }
      const int corner = static_cast<int>(c);
      list.add(corner, packer.add<T>(lanes.data(), get_length(corner)));
      ++count;
    }
    if (list.count == 0) return;
    map_coefficients = packer.finish();
    for (MappedForce<T>& force : list.element) force.table = map_coefficients->data();
  }
};

/// States of all struts with their time derivatives and decay rates: the lagged forces of all
/// struts, then the mount forces, then the displacements of the joints, then those of friction's
/// flanks; null without states.
template <class T>
struct StrutStates {
  const T* value = nullptr;
  T* rate = nullptr;
  T* decay = nullptr;
};

template <class T, int Corners>
void add_shaped_dampers(const ElementList<ShapedDamper<T>>& list,
                        const std::array<CornerMotion<T>, Corners>& motion, const T* q_dot,
                        const T& warming, const StrutStates<T>& states,
                        std::array<StrutForce<T>, Corners>& out) {
  for (int i = 0; i < list.count; ++i) {
    const int c = list.corner[static_cast<std::size_t>(i)];
    const ShapedDamper<T>& damper = list.element[static_cast<std::size_t>(i)];
    const auto corner = static_cast<std::size_t>(c);
    const T rate = motion[corner].length_q[kDamperLine] * q_dot[corner];
    T speed = -rate;
    DamperSeriesState<T> s;
    if (states.value != nullptr) {
      s.lagged = states.value[c];
      s.mount = states.value[Corners + c];
      s.joint = states.value[2 * Corners + c];
      speed = calc_joint_speed(damper.series, speed, s);
    }
    const T law_rate = damper.calc_rate(speed, warming);
    T force = law_rate * speed;
    if (states.value != nullptr) {
      force = calc_series_force(damper.series, force, law_rate, s);
      states.rate[c] = s.lagged_rate;
      states.decay[c] = s.lagged_decay;
      states.rate[Corners + c] = s.mount_rate;
      states.decay[Corners + c] = s.mount_decay;
      states.rate[2 * Corners + c] = s.joint_rate;
      states.decay[2 * Corners + c] = s.joint_decay;
    }
    if (damper.has_friction) {
      const T rubbing = select(damper.series.joint_play > T(0.0), speed, -rate);
      FrictionState<T> flank{states.value[3 * Corners + c], T(0.0), T(0.0)};
      force += calc_friction(damper.friction, rubbing, -rate, flank);
      states.rate[3 * Corners + c] = flank.rate;
      states.decay[3 * Corners + c] = flank.decay;
    }
    out[corner].damper_force += force;
    out[corner].generalized += force * motion[corner].length_q[kDamperLine];
    out[corner].power += force * rate;
  }
}

template <class T, int Corners>
void add_anti_roll_bars(const ElementList<AntiRollBar<T>>& list,
                        const std::array<CornerMotion<T>, Corners>& motion,
                        std::array<StrutForce<T>, Corners>& out) {
  for (int i = 0; i < list.count; ++i) {
    const AntiRollBar<T>& bar = list.element[static_cast<std::size_t>(i)];
    const auto left = static_cast<std::size_t>(list.corner[static_cast<std::size_t>(i)]);
    const auto right = left + 1;
    const T twist =
        bar.nominal_twist - (motion[left].length[kSpringLine] - motion[right].length[kSpringLine]);
    const T force = bar.stiffness * twist;
    out[left].generalized += force * motion[left].length_q[kSpringLine];
    out[right].generalized += -force * motion[right].length_q[kSpringLine];
    out[left].energy += T(0.5) * force * twist;
  }
}

/// Adds the forces of all effects to those of the linear elements in `out`. `warming`: temperature
/// of the dampers above the reference of their rates [K].
template <class T, int Corners>
[[gnu::noinline]] void add_strut_effects(const StrutEffects<T>& effects,
                                         const std::array<CornerMotion<T>, Corners>& motion,
                                         const T* q_dot, const T& warming,
                                         const StrutStates<T>& states,
                                         std::array<StrutForce<T>, Corners>& out) {
  if (states.value != nullptr) {
    for (int i = 0; i < kStatesPerStrut * Corners; ++i) states.rate[i] = states.decay[i] = T(0.0);
  }
  add_shaped_dampers<T, Corners>(effects.shaped, motion, q_dot, warming, {}, out);
  add_shaped_dampers<T, Corners>(effects.series, motion, q_dot, warming, states, out);
  std::apply(
      [&](const auto&... list) { (add_element_list<T, Corners>(list, motion, q_dot, out), ...); },
      effects.added);
  if constexpr (Corners > 1) add_anti_roll_bars<T, Corners>(effects.bars, motion, out);
}

}  // namespace strut
