// The car as a system for simulate.h.
#pragma once

#include "model/car/channels.h"
#include "model/car/closures.h"
#include "model/car/dynamics.h"
#include "model/integrate/simulate.h"

namespace strut {

/// Maximum residual loop error of a step [m].
inline constexpr double kClosureTolerance = 1e-10;
/// Time for which steps remain fine after the bump [s], until lifted wheels are back on the road
/// and their hop has faded (docs/design/0004-integrators.md).
inline constexpr double kSettlingTime = 0.2;

/// Integration of the wheel spin against slip: by the exponential formulas, or like all other
/// states.
enum class SpinTreatment { kExponential, kExplicit };

/// State of a system that computes the sides S: the number of its components, the component of
/// StateIndex at an index, and the index of a component.
template <Sides S>
struct SystemState : StateIndex {
  static constexpr int get(int index) { return index; }
  static constexpr int find(int component) { return component; }
};
template <>
struct SystemState<Sides::kLeft> : SymmetricStateIndex {};

/// The car, or the left side of one that moves symmetrically, whose state is that of
/// SymmetricStateIndex. The closure is called through function pointers, so that integrators are
/// compiled once for all closures.
template <class T, Sides S = Sides::kBoth>
class CarSystem {
 public:
  using Layout = SystemState<S>;
  static constexpr int kCapacity = Layout::kCount;
  static constexpr int kStride = kCornerStride<S>;
  static constexpr int kComputed = kCorners / kStride;  // corners
  static constexpr int kStrutStates = StateIndex::kStrutCount / kStride;
  using Mask = MaskOf<T>;
  static_assert(kCorners + StateIndex::kStrutCount <= kMaxStiff);

  template <class Closure>
  CarSystem(const Vehicle<T>& vehicle, const Closure& closure, SpinTreatment spin,
            const T& trigger_x)
      : vehicle_(vehicle),
        closure_(&closure),
        derivative_(&call_derivative<Closure>),
        place_wheel_(&call_place_wheel<Closure>),
        center_acceleration_(&call_center_acceleration<Closure>),
        stiff_(spin == SpinTreatment::kExponential),
        has_kinks_(vehicle.road.segment_count > 1),
        trigger_x_(trigger_x) {
    for (T& s : workspace_.segment) s = T(0.0);
  }

  int size() const {
    if (vehicle_.effects.has_states()) return Layout::kCount;
    return vehicle_.layout.relaxation ? Layout::kCountWithoutStruts
                                      : Layout::kCountWithoutRelaxation;
  }
  /// The spins of the wheels, then the states of the struts, if there are any.
  int stiff_at(int i) const {
    constexpr int kSpin = Layout::find(StateIndex::kSpin);
    constexpr int kStrut = Layout::find(StateIndex::kStrut);
    return i < kComputed ? kSpin + i : kStrut + (i - kComputed);
  }
  int stiff_count() const {
    if (!stiff_) return 0;
    return vehicle_.effects.has_states() ? kComputed + kStrutStates : kComputed;
  }

  /// Puts every wheel on the road segment under it.
  void start(const T* reduced) {
    if (!has_kinks_) return;
    T dx[kCapacity];
    derivative_(*this, reduced, dx);
    const T* x = expand(reduced);
    for (int c = 0; c < kCorners; c += kStride) {
      if (!vehicle_.layout.on_bump[c]) continue;
      workspace_.segment[c] = find_segment(vehicle_.road, calc_wheel_x(x, c));
    }
  }

  void calc_derivative(const T& /*t*/, const T* reduced, T* dx, T* decay) {
    derivative_(*this, reduced, dx);
    const T* x = get_expanded(reduced);
    if (stiff_) {
      for (int i = 0; i < kComputed; ++i) decay[i] = workspace_.spin_decay[kStride * i];
      for (int i = kComputed; i < stiff_count(); ++i) {
        decay[i] = workspace_.strut_decay[kStride * (i - kComputed)];
      }
    }
    failed_ = (!is_finite(workspace_.acceleration.z + workspace_.acceleration.x +
                          workspace_.angular_acceleration.y)) |
              (workspace_.closure_error > T(kClosureTolerance)) |
              (workspace_.travel_excess > T(0.0)) |
              (abs(x[StateIndex::kVelocity]) > T(kDivergenceSpeed)) |
              (abs(x[StateIndex::kVelocity + 2]) > T(kDivergenceSpeed));
    largest_loop_error_ = max(largest_loop_error_, workspace_.closure_error);
    update_trigger(x);
    for (int c = 0; has_kinks_ && c < kCorners; c += kStride) kink_x_[c] = calc_wheel_x(x, c);
  }

  int guard_count() const { return has_kinks_ ? 2 * kComputed : kComputed; }
  void get_guards(T* g) const {
    for (int i = 0; i < kComputed; ++i) g[i] = workspace_.contact[kStride * i].unclamped_load;
    for (int i = 0; has_kinks_ && i < kComputed; ++i) {
      g[kComputed + i] = calc_kink_distance(kStride * i);
    }
  }
  /// Guards and trigger at any state, from the positions of the wheels without the dynamics.
  void calc_guards(const T& /*t*/, const T* reduced, T* g) {
    const T* x = expand(reduced);
    workspace_.rotation = rotation_of(get_quaternion(x));
    for (int c = 0; c < kCorners; c += kStride) {
      place_wheel_(*this, c, x[StateIndex::kCorner + c]);
      if (has_kinks_) kink_x_[c] = calc_wheel_x(x, c);
    }
    for (int i = 0; i < kWheelPairs<S>; ++i) {
      update_contacts<S>(vehicle_, x, get_wheel_pair<S>(i), workspace_);
    }
    update_trigger(x);
    get_guards(g);
  }
  /// A wheel that has passed a kink moves on to the next road segment.
  bool cross(int guard, Mask lanes) {
    if (guard < kComputed) return false;
    T& segment = workspace_.segment[kStride * (guard - kComputed)];
    segment = select(lanes, segment + T(1.0), segment);
    return true;
  }

  /// True on the bump, within one and a half coarse steps before it, and for kSettlingTime after
  /// it.
  Mask wants_fine_step(const T& /*t*/, const T* x, const T* /*dx*/, const T& coarse_step) const {
    const T& speed = x[Layout::find(StateIndex::kVelocity)];
    if (vehicle_.road.is_rough()) return !(speed < speed);
    const T ahead = x[Layout::find(StateIndex::kPosition)] - vehicle_.road.center;
    const T front = ahead + vehicle_.numbers.geometry[kFrontLeft].wheel_center.x;
    const T rear = ahead + vehicle_.numbers.geometry[kRearLeft].wheel_center.x;
    return (front > vehicle_.road.reach_begin - T(1.5) * coarse_step * speed) &
           (rear < vehicle_.road.reach_end + T(kSettlingTime) * speed);
  }

  /// Mean forward position of the rear wheels that cross the bump, relative to the trigger line
  /// [m].
  T get_trigger() const { return wheel_x_ - trigger_x_; }

  Mask has_failed() const { return failed_; }
  RunStatus get_failure(int lane) const {
    const bool finite = std::isfinite(get_lane(workspace_.acceleration.z, lane));
    const bool open = get_lane(workspace_.closure_error, lane) > kClosureTolerance ||
                      get_lane(workspace_.travel_excess, lane) > 0.0;
    return finite && open ? RunStatus::kOutOfTravel : RunStatus::kDiverged;
  }

  /// Channels at the state of the last calc_derivative.
  void observe(const T& t, const T* reduced, T* out) {
    const T* x = expand(reduced);
    observe_body(vehicle_, t, x, workspace_, out);
    for (int c = 0; c < kCorners; c += kStride) {
      T* own = out + CarChannel::get_corner_channel(c, 0);
      center_acceleration_(*this, c, x[StateIndex::kCorner + c]);
      observe_corner(vehicle_, x, workspace_, c, own);
      if constexpr (S == Sides::kLeft) mirror_corner(own, own + CarChannel::kCornerChannels);
    }
  }

  /// Maximum loop error of all right-hand sides so far [m]; zero with tables.
  T get_largest_loop_error() const { return largest_loop_error_; }

  const Workspace<T>& workspace() const { return workspace_; }
  const Vehicle<T>& vehicle() const { return vehicle_; }

 private:
  template <class Closure>
  static void call_derivative(CarSystem& self, const T* reduced, T* dx) {
    const auto& closure = *static_cast<const Closure*>(self.closure_);
    const T* x = self.expand(reduced);
    if constexpr (S == Sides::kBoth) {
      strut::calc_derivative<S>(self.vehicle_, closure, TireMode::kRolling, x, dx, self.workspace_);
    } else {
      State<T> all;
      strut::calc_derivative<S>(self.vehicle_, closure, TireMode::kRolling, x, all.data(),
                                self.workspace_);
      for (int i = 0; i < self.size(); ++i) dx[i] = all[Layout::get(i)];
    }
  }
  template <class Closure>
  static void call_place_wheel(CarSystem& self, int corner, const T& q) {
    static_cast<const Closure*>(self.closure_)
        ->place_wheel(corner, q, self.workspace_.motion[corner]);
  }
  template <class Closure>
  static void call_center_acceleration(CarSystem& self, int corner, const T& q) {
    static_cast<const Closure*>(self.closure_)
        ->update_center_acceleration(corner, q, self.workspace_.motion[corner]);
  }

  /// The state in the layout of StateIndex; of a symmetric motion the right side and the lateral
  /// components are zero.
  const T* expand(const T* reduced) {
    if constexpr (S == Sides::kLeft) {
      for (int i = 0; i < size(); ++i) expanded_[Layout::get(i)] = reduced[i];
    }
    return get_expanded(reduced);
  }
  /// The state that was expanded last.
  const T* get_expanded(const T* reduced) const {
    if constexpr (S == Sides::kBoth) return reduced;
    return expanded_.data();
  }

  /// World x of a wheel center.
  T calc_wheel_x(const T* x, int corner) const {
    return x[StateIndex::kPosition] + (workspace_.rotation * workspace_.motion[corner].center).x;
  }
  void update_trigger(const T* x) {
    wheel_x_ = T(0.5) * (calc_wheel_x(x, trigger_left()) + calc_wheel_x(x, trigger_right()));
  }
  T calc_kink_distance(int corner) const {
    if (!vehicle_.layout.on_bump[corner]) return T(-1.0);
    return kink_x_[corner] - calc_segment_end(vehicle_.road, workspace_.segment[corner]);
  }
  int trigger_left() const {
    return vehicle_.layout.on_bump[kRearLeft] || !vehicle_.layout.on_bump[kRearRight] ? kRearLeft
                                                                                      : kRearRight;
  }
  int trigger_right() const {
    if constexpr (S == Sides::kLeft) return trigger_left();
    return vehicle_.layout.on_bump[kRearRight] || !vehicle_.layout.on_bump[kRearLeft] ? kRearRight
                                                                                      : kRearLeft;
  }

  const Vehicle<T>& vehicle_;
  const void* closure_;
  void (*derivative_)(CarSystem&, const T*, T*);
  void (*place_wheel_)(CarSystem&, int, const T&);
  void (*center_acceleration_)(CarSystem&, int, const T&);
  bool stiff_, has_kinks_;
  T trigger_x_;
  Workspace<T> workspace_{};
  Mask failed_{};
  T largest_loop_error_{0.0};
  T wheel_x_{};
  std::array<T, kCorners> kink_x_{};
  State<T> expanded_{};
};

}  // namespace strut
