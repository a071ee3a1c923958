// A rig as a system for simulate.h; the equations are at the head of rigs.h.
//
// State: the positions, then the velocities, of the rig's masses (two by RigCoordinate, one, or
// none for strut_rig, whose inputs impose the motion); then, where effects give the strut states,
// its lagged force, the force of its mount and the displacements of its joint and of its friction;
// then, where the guides' friction has a flank, its displacements by mass.
//
// A kink of a piecewise linear input is not an event: where the order of the integrator matters,
// choose steps that end at the samples, or interpolate by a spline.
#pragma once

#include <cmath>
#include <limits>

#include "model/integrate/simulate.h"
#include "model/rig/rigs.h"

namespace strut {

/// Intermediate results of the right-hand side.
template <class T>
struct RigWorkspace {
  std::array<SignalPoint<T>, kMaxRigInputs> input;  // in the order of the rig's inputs
  std::array<CornerMotion<T>, 1> motion;            // only length and length_q are used
  std::array<StrutForce<T>, 1> strut;
  T unclamped_load, tire_force;                 // N
  std::array<T, kRigCoordinates> guide_force;   // N, on the masses, upwards
  T actuator_force;                             // N, between the masses, pushes them apart
  std::array<T, kRigCoordinates> acceleration;  // m/s^2
  /// Decay rates [1/s] of the strut's states, followed by those of the guides' states.
  std::array<T, kStatesPerStrut + kRigCoordinates> stiff_decay;
};

/// Temperature at which a damper has its nominal rate [K].
inline constexpr double kReferenceTemperature = 293.15;

template <class T>
class RigSystem {
 public:
  static constexpr int kCapacity = 3 * kRigCoordinates + kStatesPerStrut;
  using Mask = MaskOf<T>;

  /// `inputs` by assign_rig_inputs. Rig and signals must outlive the system.
  RigSystem(const Rig<T>& rig, const std::array<const InputSignal*, kMaxRigInputs>& inputs)
      : rig_(rig),
        inputs_(inputs),
        count_(static_cast<int>(get_rig_info(rig.layout.kind).masses.size())),
        on_ground_(get_rig_info(rig.layout.kind).has(kHasGroundInput)) {}

  int size() const { return 2 * count_ + stiff_count(); }
  int stiff_at(int i) const { return 2 * count_ + i; }
  int stiff_count() const { return strut_state_count() + (rig_.layout.has_flanks ? count_ : 0); }

  /// The initial state: at rest on the ground's first position, plus the initial offsets; the
  /// states of a strut as after a long motion at its initial speed; friction of guides with a flank
  /// holds the masses where they are, as far as it can.
  std::array<T, kCapacity> make_start() {
    std::array<T, kCapacity> x;
    x.fill(T(0.0));
    const bool moves = on_ground_ && inputs_[0];
    const T ground =
        moves ? rig_.numbers.ground_gain * calc_signal(*inputs_[0], T(0.0)).value : T(0.0);
    for (int i = 0; i < count_; ++i) {
      x[at(i)] = ground + rig_.numbers.initial_position[at(i)];
      x[at(count_ + i)] = rig_.numbers.initial_velocity[at(i)];
    }
    if (rig_.effects.has_states()) settle_strut(x.data());
    if (rig_.layout.has_flanks) settle_guides(x.data());
    return x;
  }

  void calc_derivative(const T& t, const T* x, T* dx, T* decay) {
    update_inputs(t);
    states_ = flanks_ = {};
    const int stiff = 2 * count_;
    if (rig_.effects.has_states()) states_ = {x + stiff, dx + stiff, ws_.stiff_decay.data()};
    if (rig_.layout.has_flanks) {
      const int first = strut_state_count();
      flanks_ = {x + stiff + first, dx + stiff + first, ws_.stiff_decay.data() + first};
    }
    failed_ = !is_finite(T(0.0));
    switch (rig_.layout.kind) {
      case RigKind::kQuarterCar:
        accelerate_quarter_car(x);
        break;
      case RigKind::kStrutRig:
        update_strut(-ws_.input[0].value, -ws_.input[0].rate);
        break;
      case RigKind::kSingleMass:
        update_strut(x[0], x[1]);
        update_guide(0, x[1]);
        accelerate_one_mass(ws_.input[0].value);
        break;
      case RigKind::kGuidedMass:
        update_strut(x[0] - ws_.input[0].value, x[1] - ws_.input[0].rate);
        update_guide(0, x[1]);
        accelerate_one_mass(ws_.input[1].value);
        break;
    }
    for (int i = 0; i < count_; ++i) {
      dx[i] = x[count_ + i];
      dx[count_ + i] = ws_.acceleration[at(i)];
      failed_ = failed_ | (!is_finite(dx[count_ + i])) | (abs(dx[i]) > T(kDivergenceSpeed));
    }
    for (int i = 0; i < stiff_count(); ++i) decay[i] = ws_.stiff_decay[at(i)];
  }

  /// The tire's lift-off and touch-down.
  int guard_count() const { return rig_.layout.unilateral_tire ? 1 : 0; }
  void get_guards(T* g) const { g[0] = ws_.unclamped_load; }
  void calc_guards(const T& t, const T* x, T* g) {
    ws_.input[0] = read_first_input(t);
    input_time_ = T(kNoTime);
    update_tire(x);
    get_guards(g);
  }
  bool cross(int /*guard*/, Mask /*lanes*/) { return false; }

  /// Whether a joint is crossing its play, has just crossed it, or may begin to within a coarse
  /// step: elsewhere the contact follows the strut's speed, and the exponential formulas follow the
  /// contact. Fine steps go on to the end of the coarse step in which they began, so that samples
  /// remain at ends of steps.
  Mask wants_fine_step(const T& t, const T* x, const T* dx, const T& coarse_step) const {
    constexpr double kSettled = 0.05, kMargin = 1.5, kOnGrid = 1e-6;
    if (!rig_.effects.has_states()) return T(1.0) < T(0.0);
    const DamperSeries<T>& series = rig_.numbers.effects.series;
    DamperSeriesState<T> state;
    state.joint = x[2 * count_ + 2];
    const SignalPoint<T> base = read_first_input(t);
    const T speed = calc_strut_rate(x, base.rate), behind = calc_joint_speed(series, speed, state);
    const auto inside = abs(state.joint) <= T(0.5) * series.play;
    const auto settles = abs(behind - speed) > T(kSettled) * abs(speed);
    const auto reverses =
        abs(speed) < T(kMargin) * coarse_step * abs(calc_strut_rate(dx, base.second_rate));
    const T steps = t / coarse_step;
    const auto off_grid = abs(steps - floor(steps + T(0.5))) > T(kOnGrid);
    return (series.play > T(0.0)) & (inside | settles | reverses | off_grid);
  }

  /// Constant, because a rig has no snapshot.
  T get_trigger() const { return T(1.0); }
  Mask has_failed() const { return failed_; }
  RunStatus get_failure(int /*lane*/) const { return RunStatus::kDiverged; }

  /// Channels at the state of the last calc_derivative.
  void observe(const T& t, const T* x, T* out) const {
    switch (rig_.layout.kind) {
      case RigKind::kQuarterCar:
        return observe_quarter_car(t, x, out);
      case RigKind::kStrutRig:
        return observe_strut_rig(t, out);
      case RigKind::kSingleMass:
        return observe_single_mass(t, x, out);
      case RigKind::kGuidedMass:
        return observe_guided_mass(t, x, out);
    }
  }

  const RigWorkspace<T>& workspace() const { return ws_; }

 private:
  static constexpr double kNoTime = std::numeric_limits<double>::quiet_NaN();
  static constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

  int strut_state_count() const { return rig_.effects.has_states() ? kStatesPerStrut : 0; }

  /// A gain scales the motion of the ground; other inputs are as recorded.
  SignalPoint<T> read_first_input(const T& t) const {
    if (!inputs_[0]) return {0.0, 0.0, 0.0};
    const SignalPoint<T> input = calc_signal(*inputs_[0], t);
    if (!on_ground_) return input;
    const T& gain = rig_.numbers.ground_gain;
    return {gain * input.value, gain * input.rate, gain * input.second_rate};
  }
  /// Stages of a step share their times, so half of the readings are those of the stage before.
  void update_inputs(const T& t) {
    if (all((t >= input_time_) & (t <= input_time_))) return;
    input_time_ = t;
    ws_.input.fill({0.0, 0.0, 0.0});
    ws_.input[0] = read_first_input(t);
    if (inputs_[1]) ws_.input[1] = calc_signal(*inputs_[1], t);
  }

  T get_temperature() const { return inputs_[1] ? ws_.input[1].value : rig_.numbers.temperature; }

  void settle_strut(T* x) {
    update_inputs(T(0.0));
    const T speed = calc_strut_rate(x, ws_.input[0].rate);
    const ShapedDamper<T>& damper = rig_.effects.series.element.front();
    x[2 * count_] = x[2 * count_ + 1] = damper.calc_rate(speed, calc_warming()) * speed;
    x[2 * count_ + 2] = calc_settled_joint(damper.series, speed);
    if (damper.has_friction) {
      x[2 * count_ + 3] = calc_settled_friction(damper.friction, speed);
    }
  }

  void settle_guides(T* x) {
    std::array<T, kCapacity> dx, decay;
    calc_derivative(T(0.0), x, dx.data(), decay.data());
    for (int i = 0; i < count_; ++i) {
      const DryFriction<T>& friction = rig_.numbers.guide[at(i)];
      const T pull = rig_.numbers.mass[at(i)] * ws_.acceleration[at(i)];
      const T most = friction.force * calc_guide_side(pull);
      const auto acts = most > T(0.0);
      const T z = pull / select(acts, most, T(1.0));
      x[2 * count_ + strut_state_count() + i] =
          select(acts, friction.stroke * min(max(z, T(-1.0)), T(1.0)), T(0.0));
    }
  }

  /// Speed of the strut [m/s], positive in compression, at state `x` and the rate of the input that
  /// moves its end; its acceleration from the state's derivative and the second rate.
  T calc_strut_rate(const T* x, const T& base) const {
    switch (rig_.layout.kind) {
      case RigKind::kQuarterCar:
        return x[2 + kUnsprung] - x[2 + kSprung];
      case RigKind::kStrutRig:
        return base;
      case RigKind::kSingleMass:
        return -x[1];
      case RigKind::kGuidedMass:
        break;
    }
    return base - x[1];
  }

  T calc_warming() const {
    if (rig_.layout.kind != RigKind::kStrutRig) return T(0.0);
    return get_temperature() - T(kReferenceTemperature);
  }

  /// Forces of the strut at `length` [m], the increase of its length from rest.
  void update_strut(const T& length, const T& rate) {
    ws_.motion[0].length.fill(length);
    ws_.motion[0].length_q.fill(T(1.0));
    add_strut_forces<T, 1>(rig_.struts, ws_.motion, &rate, ws_.strut);
    if (rig_.effects.count == 0) return;
    add_strut_effects<T, 1>(rig_.effects, ws_.motion, &rate, calc_warming(), states_, ws_.strut);
  }

  void update_tire(const T* x) {
    const RigParameters<T>& p = rig_.numbers;
    const T deflection = p.static_deflection + ws_.input[0].value - x[kUnsprung];
    const T rate = ws_.input[0].rate - x[2 + kUnsprung];
    const bool unilateral = rig_.layout.unilateral_tire;
    ws_.unclamped_load = unilateral ? calc_unclamped_load(p.tire, deflection, rate)
                                    : p.tire.stiffness * deflection + p.tire.damping * rate;
    if (rig_.layout.progressive_tire) {
      ws_.unclamped_load += calc_progressive_load(p.tire, deflection);
    }
    if (rig_.layout.tire_curve) {
      ws_.unclamped_load += calc_curved_load(p.tire, *rig_.layout.tire_curve, deflection);
    }
    ws_.tire_force = unilateral ? max(ws_.unclamped_load, T(0.0)) : ws_.unclamped_load;
  }

  void accelerate_quarter_car(const T* x) {
    const RigParameters<T>& p = rig_.numbers;
    update_strut(x[kSprung] - x[kUnsprung], x[2 + kSprung] - x[2 + kUnsprung]);
    update_tire(x);
    update_actuator(x);
    update_guide(kUnsprung, x[2 + kUnsprung]);
    update_guide(kSprung, x[2 + kSprung]);
    const T between = ws_.strut[0].generalized + ws_.actuator_force;
    const auto accelerate = [&](int mass, const T& force) {
      ws_.acceleration[at(mass)] =
          (force + ws_.guide_force[at(mass)]) * (T(1.0) / p.mass[at(mass)]) - p.gravity;
    };
    accelerate(kUnsprung, ws_.tire_force - between);
    accelerate(kSprung, between);
  }

  /// `applied`: all forces except those of strut and guide, and the weight.
  void accelerate_one_mass(const T& applied) {
    ws_.acceleration[0] = (applied + ws_.guide_force[0] + ws_.strut[0].generalized) *
                              (T(1.0) / rig_.numbers.mass[0]) -
                          rig_.numbers.gravity;
  }

  /// The recorded command and the feedback of the states.
  void update_actuator(const T* x) {
    ws_.actuator_force = ws_.input[1].value;
    if (!rig_.layout.has_feedback) return;
    const auto& [deflection, sprung, tire, unsprung] = rig_.numbers.feedback;
    ws_.actuator_force += deflection * (x[kSprung] - x[kUnsprung]) + sprung * x[2 + kSprung] +
                          tire * (x[kUnsprung] - ws_.input[0].value) + unsprung * x[2 + kUnsprung];
  }

  T calc_guide_side(const T& z) const {
    const T& a = rig_.numbers.guide_asymmetry;
    return select(z > T(0.0), T(1.0) + a, T(1.0) - a);
  }

  /// Friction of a guide on the ground, against the velocity of its mass.
  void update_guide(int mass, const T& velocity) {
    ws_.guide_force[at(mass)] = T(0.0);
    if (!rig_.layout.has_guide) return;
    const DryFriction<T>& friction = rig_.numbers.guide[at(mass)];
    FrictionState<T> flank{T(0.0), T(0.0), T(0.0)};
    if (rig_.layout.has_flanks) flank.value = flanks_.value[mass];
    const T force = calc_friction(friction, velocity, velocity, flank);
    if (rig_.layout.has_flanks) {
      flanks_.rate[mass] = flank.rate;
      flanks_.decay[mass] = flank.decay;
    }
    ws_.guide_force[at(mass)] = -calc_guide_side(force) * force;
  }

  void observe_quarter_car(const T& t, const T* x, T* out) const {
    using C = QuarterCarChannel;
    out[C::kTime] = t;
    out[C::kRoadPosition] = ws_.input[0].value;
    out[C::kRoadVelocity] = ws_.input[0].rate;
    out[C::kRoadAcceleration] = ws_.input[0].second_rate;
    for (int i = 0; i < kRigCoordinates; ++i) {
      out[C::kUnsprungPosition + i] = x[i];
      out[C::kUnsprungVelocity + i] = x[2 + i];
      out[C::kUnsprungAcceleration + i] = ws_.acceleration[at(i)];
    }
    out[C::kActuatorForce] = ws_.actuator_force;
    out[C::kSpringForce] = ws_.strut[0].spring_force;
    out[C::kDamperForce] = ws_.strut[0].damper_force;
    out[C::kTireForce] = ws_.tire_force;
  }

  void observe_strut_rig(const T& t, T* out) const {
    using C = StrutRigChannel;
    out[C::kTime] = t;
    out[C::kDisplacement] = ws_.input[0].value;
    out[C::kVelocity] = ws_.input[0].rate;
    out[C::kAcceleration] = ws_.input[0].second_rate;
    out[C::kForce] = ws_.strut[0].generalized + rig_.numbers.moving_mass * ws_.input[0].second_rate;
    out[C::kSpringForce] = ws_.strut[0].spring_force;
    out[C::kDamperForce] = ws_.strut[0].damper_force;
    out[C::kTemperature] = get_temperature();
  }

  void observe_single_mass(const T& t, const T* x, T* out) const {
    using C = SingleMassChannel;
    out[C::kTime] = t;
    out[C::kPosition] = x[0];
    out[C::kVelocity] = x[1];
    out[C::kAcceleration] = ws_.acceleration[0];
    out[C::kForce] = ws_.input[0].value;
    out[C::kSpringForce] = ws_.strut[0].spring_force;
    out[C::kDamperForce] = ws_.strut[0].damper_force;
    out[C::kGuideForce] = ws_.guide_force[0];
  }

  void observe_guided_mass(const T& t, const T* x, T* out) const {
    using C = GuidedMassChannel;
    out[C::kTime] = t;
    out[C::kBasePosition] = ws_.input[0].value;
    out[C::kPosition] = x[0];
    out[C::kBaseVelocity] = ws_.input[0].rate;
    out[C::kVelocity] = x[1];
    out[C::kBaseAcceleration] = ws_.input[0].second_rate;
    out[C::kAcceleration] = ws_.acceleration[0];
    out[C::kForce] = ws_.input[1].value;
    out[C::kSpringForce] = ws_.strut[0].spring_force;
    out[C::kDamperForce] = ws_.strut[0].damper_force;
    out[C::kGuideForce] = ws_.guide_force[0];
  }

  const Rig<T>& rig_;
  std::array<const InputSignal*, kMaxRigInputs> inputs_;
  T input_time_ = T(kNoTime);  // of ws_.input
  int count_;
  bool on_ground_;
  RigWorkspace<T> ws_{};
  StrutStates<T> states_, flanks_;  // of the strut, of the guides' friction
  Mask failed_{};
};

/// Simulates kLaneCount<T> rigs of one kind under the same inputs for `plan.duration` [s]; the
/// history holds the rig's channels every `plan.interval` [s]. Throws ModelError as make_rig and
/// assign_rig_inputs do.
template <class T>
LaneResults simulate_rigs(const RigSpec* const specs[], const std::vector<InputSignal>& inputs,
                          const StepOptions& options, SamplePlan plan) {
  const Rig<T> rig = make_rig<T>(specs);
  RigSystem<T> system(rig, assign_rig_inputs(rig.layout.kind, inputs));
  plan.snapshot = false;
  plan.channel_count = static_cast<int>(get_rig_info(rig.layout.kind).channels.size());
  return Simulation<T, RigSystem<T>>(system, options, plan).run(system.make_start());
}

/// The same for one rig in double.
inline LaneResults simulate_rig(const RigSpec& spec, const std::vector<InputSignal>& inputs,
                                const StepOptions& options, const SamplePlan& plan) {
  const RigSpec* const specs[] = {&spec};
  return simulate_rigs<double>(specs, inputs, options, plan);
}

}  // namespace strut
