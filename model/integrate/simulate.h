// Runs a system from t = 0 to its end in lockstep lanes: steps, contact events, snapshot, samples.
//
// Every lane has its own time grid. A lane whose guard changes sign inside a step (a wheel lifts
// off, touches down or reaches a kink of the road) takes a shorter RK4 step that ends there and
// restarts its multistep history; its neighbors keep their step and every bit of their result.
//
// Besides the functions of steppers.h a system offers, all after calc_derivative at the same state:
//   int guard_count() const;  void get_guards(T* g) const;
//   T get_trigger() const;                         its sign change is the snapshot
//   MaskOf<T> has_failed() const;                  loops not closed, or state not finite
//   void observe(const T& t, const T* x, T* out);  channels
// and at any state
//   void calc_guards(const T& t, const T* x, T* g);
//   bool cross(int guard, MaskOf<T> lanes);        lanes that passed it; true: reevaluate f
// and, if it supports long steps (StepOptions::coarse_step),
//   MaskOf<T> wants_fine_step(const T& t, const T* x, const T* dx, const T& coarse_step) const;
#pragma once

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "model/integrate/run_plan.h"
#include "model/integrate/steppers.h"

namespace strut {

template <class T, class System>
class Simulation {
 public:
  static constexpr int N = System::kCapacity;
  static constexpr int kLanes = kLaneCount<T>;
  static constexpr int kMaxGuards = 8;  // capacity; a car on a road with kinks has eight
  /// Step budget, as a multiple of the steps of an event-free run; a run that exceeds it is
  /// reported as stalled.
  static constexpr double kMaxStepRatio = 20.0;
  /// Minimum length of an event-shortened step, as a fraction of the step: without it two wheels
  /// that cross within rounding could shorten each other's steps until time stands still.
  static constexpr double kMinStepFraction = 1e-9;
  using Vector = std::array<T, N>;
  using Mask = MaskOf<T>;

  Simulation(System& system, const StepOptions& options, const SamplePlan& plan)
      : system_(system), options_(options), plan_(plan) {}

  /// Integrates from x0; all allocations happen before the first step.
  LaneResults run(const Vector& x0) {
    prepare(x0);
    while (any(time_ < end_)) advance();
    finish();
    return std::move(results_);
  }

 private:
  void prepare(const Vector& x0) {
    const auto lanes = static_cast<std::size_t>(kLanes);
    const auto channels = static_cast<std::size_t>(plan_.channel_count);
    results_ = {};
    results_.lanes = kLanes;
    results_.status.assign(lanes, 0);
    results_.failure_time.assign(lanes, plan_.duration);
    results_.event_time.assign(lanes, std::nan(""));
    results_.snapshot.assign(channels * lanes, std::nan(""));
    results_.sample_count = count_samples(plan_);
    results_.recorded = plan_.recorded;
    history_row_ = static_cast<std::size_t>(plan_.recorded_count()) * lanes;
    results_.history.assign(static_cast<std::size_t>(results_.sample_count) * history_row_,
                            std::nan(""));
    results_.slopes.assign(kDirectionCount<T>, results_);
    channel_.resize(channels);
    x_ring_[0] = x0;
    head_ = 0;
    time_ = h_ = T(0.0);
    end_ = T(plan_.duration);
    for (std::size_t lane = 0; lane < plan_.lane_durations.size(); ++lane) {
      results_.failure_time[lane] = plan_.lane_durations[lane];
      set_lane(end_, static_cast<int>(lane), plan_.lane_durations[lane]);
    }
    max_steps_ = T(kMaxStepRatio / options_.step) * end_;
    past_count_ = T(0.0);
    past_step_ = T(0.0);
    step_count_ = T(0.0);
    next_sample_ = T(0.0);
    triggered_ = T(plan_.snapshot ? 0.0 : 1.0);
    evaluate(time_, x(), f(), decay_.data());
    system_.get_guards(guard_.data());
    for (int g = 0; g < system_.guard_count(); ++g) {
      side_[g] = calc_side(guard_[g]);
    }
    trigger_ = system_.get_trigger();
    retire_failed();
    record_samples_at_start();
  }

  void evaluate(const T& t, const T* x, T* dx, T* decay) {
    system_.calc_derivative(t, x, dx, decay);
    ++results_.derivative_count;
  }

  /// One step of every lane that has not ended.
  void advance() {
    step_count_ = step_count_ + T(1.0);
    const T nominal = choose_step();
    const T left = max(end_ - time_, T(0.0));
    const Mask last = left < nominal * T(1.0 + 1e-9);
    h_ = select(last, left, nominal);
    const Mask full = h_ > nominal * T(1.0 - 1e-9);
    update_stiff_weights(decay_.data(), h_, system_.stiff_count(), weights_);
    past_count_ = select(abs(nominal - past_step_) > T(0.0), T(0.0), past_count_);
    past_step_ = nominal;
    if (system_.size() > 0) take_step(full);
    evaluate(time_ + h_, x1(), f1(), decay1_.data());
    system_.get_guards(guard1_.data());
    trigger1_ = system_.get_trigger();
    T landed = T(-1.0);  // guard at which a lane's step now ends
    if (options_.locate_events && system_.guard_count() > 0) landed = locate_events();
    retire_failed();
    if (plan_.snapshot) locate_trigger();
    if (results_.sample_count > 0) record_samples();
    // The right-hand side switches after the samples are recorded, because the step just taken
    // belongs to the old side.
    const Mask restarted = landed > T(-0.5);
    const bool guarded = system_.guard_count() > 0;
    if (any(restarted) || (guarded && !options_.locate_events)) pass_guards(restarted, landed);
    commit(restarted, last);
  }

  /// The fine or the coarse step, by each lane's own state.
  T choose_step() {
    const T fine(options_.step);
    if constexpr (requires { system_.wants_fine_step(time_, x(), f(), T(0.0)); }) {
      if (options_.coarse_step > 0.0) {
        const T coarse(options_.coarse_step);
        return select(system_.wants_fine_step(time_, x(), f(), coarse), fine, coarse);
      }
    }
    return fine;
  }

  /// Computes x1 by the multistep formula in lanes with enough history, else by RK4.
  void take_step(Mask full) {
    const Mask multistep =
        options_.stepper == Stepper::kAbm4 ? (past_count_ > T(2.5)) & full : past_count_ < T(-1.0);
    const Mask active = time_ < end_;
    const bool some_multistep = any(multistep & active);
    if (some_multistep) {
      step_abm4<T>(system_, time_, x(), f(), get_past(), weights_, h_, x1(), scratch_);
      ++results_.derivative_count;
    }
    if (any((!multistep) & active)) {
      T* target = some_multistep ? other_.data() : x1();
      step_rk4<T>(system_, time_, x(), f(), weights_, h_, target, scratch_);
      results_.derivative_count += 3;
      if (some_multistep) {
        for (int i = 0; i < system_.size(); ++i) x1()[i] = select(multistep, x1()[i], other_[i]);
      }
    }
  }

  /// 1 where a guard is positive, 0 elsewhere.
  static T calc_side(const T& guard) { return select(guard > T(0.0), T(1.0), T(0.0)); }

  /// Shortens the step of lanes in which a guard changed sides, so that it ends at the first
  /// change. Returns the guard at which each lane's step now ends, -1 without any.
  T locate_events() {
    const int guards = system_.guard_count();
    const T shortest = T(kMinStepFraction) * h_;
    T landed = T(-1.0);
    for (int attempt = 0; attempt < kMaxGuards; ++attempt) {
      T theta = T(2.0), chosen = T(-1.0);
      for (int g = 0; g < guards; ++g) {
        const T side1 = calc_side(guard1_[g]);
        Mask changed =
            (abs(side1 - side_[g]) > T(0.5)) & (abs(landed - T(g)) > T(0.5)) & (time_ < end_);
        if (options_.refines_events) changed = changed & (!is_joined(g, landed));
        const Mask inside = guard_[g] * guard1_[g] < T(0.0);
        // Crossed between steps within rounding: there is no root to locate in this step.
        side_[g] = select(changed & (!inside), side1, side_[g]);
        const T guess = guard_[g] / (guard_[g] - guard1_[g]);
        const Mask first = changed & inside & (guess < theta);
        theta = select(first, guess, theta);
        chosen = select(first, T(g), chosen);
      }
      const Mask crossing = chosen > T(-0.5);
      if (!any(crossing)) break;
      shorten_step(crossing, max(refine_crossing(crossing, chosen) * h_, shortest));
      if (options_.refines_events) shorten_step(crossing, max(correct_step(chosen), shortest));
      landed = select(crossing, chosen, landed);
    }
    return landed;
  }

  /// Root of each lane's chosen guard on the dense output, as a fraction of h_ (Illinois method).
  T refine_crossing(Mask crossing, const T& chosen) {
    const int guards = system_.guard_count();
    T a = T(0.0), b = T(1.0), ga = T(1.0), gb = T(-1.0);
    for (int g = 0; g < guards; ++g) {
      const Mask mine = abs(chosen - T(g)) < T(0.5);
      ga = select(mine, guard_[g], ga);
      gb = select(mine, guard1_[g], gb);
    }
    constexpr int kIterations = 8;
    T theta = T(1.0), kept = T(0.0);  // end kept in the last iteration: -1 for a, +1 for b
    std::array<T, kMaxGuards> g_now;
    for (int i = 0; i < kIterations; ++i) {
      theta = select(crossing, (a * gb - b * ga) / (gb - ga), T(1.0));
      interpolate_state(x(), f(), x1(), f1(), h_, theta, system_.size(), other_.data());
      system_.calc_guards(time_ + theta * h_, other_.data(), g_now.data());
      T value = T(0.0);
      for (int g = 0; g < guards; ++g) {
        value = select(abs(chosen - T(g)) < T(0.5), g_now[g], value);
      }
      // The value at an end that is kept twice is halved, which prevents one-sided convergence.
      const Mask replaces_b = value * gb > T(0.0);
      ga = select(replaces_b, select(kept < T(-0.5), T(0.5) * ga, ga), value);
      gb = select(replaces_b, value, select(kept > T(0.5), T(0.5) * gb, gb));
      a = select(replaces_b, a, theta);
      b = select(replaces_b, theta, b);
      kept = select(replaces_b, T(-1.0), T(1.0));
    }
    return theta;
  }

  /// Step length at which each lane's chosen guard vanishes, by Newton's method from the step just
  /// taken, whose end misses it by the error of the dense output.
  T correct_step(const T& chosen) {
    constexpr double kBack = 1e-2;  // of the step, over which the slope is taken
    interpolate_state(x(), f(), x1(), f1(), h_, T(1.0 - kBack), system_.size(), other_.data());
    std::array<T, kMaxGuards> before;
    system_.calc_guards(time_ + T(1.0 - kBack) * h_, other_.data(), before.data());
    T correction = T(0.0);
    for (int g = 0; g < system_.guard_count(); ++g) {
      const T slope = (guard1_[g] - before[g]) * T(1.0 / kBack);
      const T step = max(min(guard1_[g] / slope, T(kBack)), T(-kBack));
      correction = select((abs(chosen - T(g)) < T(0.5)) & (abs(slope) > T(0.0)), step, correction);
    }
    return min(h_ - correction * h_, end_ - time_);
  }

  void shorten_step(Mask lanes, const T& h) {
    h_ = select(lanes, h, h_);
    update_stiff_weights(decay_.data(), h_, system_.stiff_count(), weights_);
    step_rk4<T>(system_, time_, x(), f(), weights_, h_, other_.data(), scratch_);
    results_.derivative_count += 3;
    for (int i = 0; i < system_.size(); ++i) x1()[i] = select(lanes, other_[i], x1()[i]);
    evaluate(time_ + h_, x1(), f1(), decay1_.data());
    system_.get_guards(guard1_.data());
    trigger1_ = system_.get_trigger();
  }

  /// Lanes in which guard g is as near to zero as that at which the step ended (`landed`; -1: at
  /// none), so that they are one event: both wheels of an axle lift off, touch down or reach a kink
  /// at once.
  Mask is_joined(int g, const T& landed) const {
    // Relative distances from zero: far above rounding, and far below a step's other events, for
    // steps that begin so near to an event that they locate it badly.
    constexpr double kTogether = 1e-7, kFarthest = 1e-4;
    T residual(0.0);
    for (int other = 0; options_.refines_events && other < system_.guard_count(); ++other) {
      const Mask ended = abs(landed - T(other)) < T(0.5);
      residual = select(ended, abs(guard1_[other]) / abs(guard_[other]), residual);
    }
    const T distance = max(T(kTogether), min(T(2.0) * residual, T(kFarthest)));
    return (landed > T(-0.5)) & (abs(guard1_[g]) <= distance * abs(guard_[g]));
  }

  /// Lanes that passed guard g in the step just taken: the step ended there or at a guard joined
  /// with it. If events are not located: the guard changed sides anywhere in the step.
  Mask find_passed(int g, Mask restarted, const T& landed) const {
    if (!options_.locate_events) {
      const T side1 = calc_side(guard1_[g]);
      return (abs(side1 - side_[g]) > T(0.5)) & (time_ < end_);
    }
    return restarted & ((abs(landed - T(g)) < T(0.5)) | is_joined(g, landed));
  }

  /// Registers the passed guards; reevaluates f1 where the right-hand side changes with them.
  void pass_guards(Mask restarted, const T& landed) {
    bool renew = false;
    std::array<Mask, kMaxGuards> passed;
    for (int g = 0; g < system_.guard_count(); ++g) {
      passed[g] = find_passed(g, restarted, landed);
      if (!any(passed[g])) continue;
      side_[g] = select(passed[g], T(1.0) - side_[g], side_[g]);
      renew = system_.cross(g, passed[g]) || renew;
    }
    for (int lane = 0; lane < kLanes; ++lane) {
      results_.event_count += get_mask_lane(restarted, lane) ? 1 : 0;
    }
    if (!renew) return;
    evaluate(time_ + h_, x1(), f1(), decay1_.data());
    T renewed[kMaxGuards];
    system_.get_guards(renewed);
    for (int g = 0; g < system_.guard_count(); ++g) {
      // The guard of a kink now measures the distance to the next kink: its side is reset.
      const Mask fresh = passed[g] & (abs(renewed[g] - guard1_[g]) > T(1e-6));
      side_[g] = select(fresh, calc_side(renewed[g]), side_[g]);
      guard1_[g] = renewed[g];
    }
  }

  void retire_failed() {
    const Mask stalled = step_count_ > max_steps_;
    const Mask failed = (system_.has_failed() | stalled) & (time_ < end_);
    if (!any(failed)) return;
    // A run that goes on after its snapshot only because of those beside it has its result.
    const Mask done = triggered_ > T(plan_.until_snapshot ? 0.5 : 2.0);
    for (int lane = 0; lane < kLanes; ++lane) {
      if (!get_mask_lane(failed & (!done), lane)) continue;
      const auto at = static_cast<std::size_t>(lane);
      results_.status[at] = static_cast<int>(
          get_mask_lane(stalled, lane) ? RunStatus::kStalled : system_.get_failure(lane));
      results_.failure_time[at] = get_lane(time_, lane);
    }
    retire(failed);
  }

  /// Ends lanes: each remains at the state before this step, its last valid one.
  void retire(Mask lanes) {
    end_ = select(lanes, time_, end_);
    h_ = select(lanes, T(0.0), h_);
    for (int i = 0; i < system_.size(); ++i) {
      x1()[i] = select(lanes, x()[i], x1()[i]);
      f1()[i] = select(lanes, T(0.0), f1()[i]);
    }
  }

  /// Snapshot of the lanes whose trigger changed sign: three RK4 steps towards the root refine the
  /// dense output's root to the accuracy of the integrator itself.
  void locate_trigger() {
    const Mask hit =
        (trigger_ < T(0.0)) & (trigger1_ >= T(0.0)) & (triggered_ < T(0.5)) & (time_ < end_);
    if (!any(hit)) return;
    T theta = trigger_ / (trigger_ - trigger1_);
    StiffWeights<T> weights;
    for (int i = 0; i < 3; ++i) {
      const T h = select(hit, theta, T(0.0)) * h_;
      update_stiff_weights(decay_.data(), h, system_.stiff_count(), weights);
      step_rk4<T>(system_, time_, x(), f(), weights, h, other_.data(), scratch_);
      evaluate(time_ + h, other_.data(), other_f_.data(), scratch_.unused_decay.data());
      results_.derivative_count += 3;
      const T error = system_.get_trigger();
      if (i == 2) break;
      // Newton with the mean slope of the step, because the trigger's speed is nearly constant.
      theta = theta - select(hit, error / (trigger1_ - trigger_), T(0.0));
    }
    const T at = time_ + theta * h_;
    system_.observe(at, other_.data(), channel_.data());
    for (int lane = 0; lane < kLanes; ++lane) {
      if (!get_mask_lane(hit, lane)) continue;
      store(&LaneResults::event_time, static_cast<std::size_t>(lane), at, lane);
      store_channels(&LaneResults::snapshot, 0, lane);
    }
    triggered_ = select(hit, T(1.0), triggered_);
    if (plan_.until_snapshot && results_.sample_count == 0) retire(hit);
  }

  /// One lane of `value` into element `at` of an array of the results, its derivatives into that of
  /// the slopes.
  void store(std::vector<double> LaneResults::*array, std::size_t at, const T& value, int lane) {
    (results_.*array)[at] = get_lane(value, lane);
    for (std::size_t i = 0; i < kDirectionCount<T>; ++i) {
      (results_.slopes[i].*array)[at] = get_slope(value, i, lane);
    }
  }

  /// All channels into the row of an array that begins at `row`.
  void store_channels(std::vector<double> LaneResults::*array, std::size_t row, int lane) {
    for (std::size_t c = 0; c < channel_.size(); ++c) {
      store(array, row + c * kLanes + static_cast<std::size_t>(lane), channel_[c], lane);
    }
  }

  void store_sample(Mask lanes) {
    for (int lane = 0; lane < kLanes; ++lane) {
      if (!get_mask_lane(lanes, lane)) continue;
      const auto sample = static_cast<std::size_t>(get_lane(next_sample_, lane));
      std::size_t row = sample * history_row_;
      if (plan_.recorded.empty()) {
        store_channels(&LaneResults::history, row, lane);
        continue;
      }
      row += static_cast<std::size_t>(lane);
      for (const int c : plan_.recorded) {
        store(&LaneResults::history, row, channel_[static_cast<std::size_t>(c)], lane);
        row += kLanes;
      }
    }
    next_sample_ = select(lanes, next_sample_ + T(1.0), next_sample_);
  }

  void record_samples_at_start() {
    if (results_.sample_count == 0) return;
    system_.observe(time_, x(), channel_.data());
    store_sample(time_ <= end_);
  }

  /// Records the samples that fall into this step, on the dense output.
  void record_samples() {
    const T slack = T(1e-9 * options_.step);
    while (true) {
      const T due = calc_sample_time(plan_, next_sample_);
      const Mask pending = (due <= time_ + h_ + slack) & (time_ < end_) &
                           (next_sample_ < T(results_.sample_count - 0.5));
      if (!any(pending)) return;
      const T theta = select(pending, min((due - time_) / max(h_, T(1e-300)), T(1.0)), T(0.0));
      interpolate_state(x(), f(), x1(), f1(), h_, theta, system_.size(), other_.data());
      evaluate(due, other_.data(), other_f_.data(), scratch_.unused_decay.data());
      system_.observe(due, other_.data(), channel_.data());
      store_sample(pending);
    }
  }

  void commit(Mask restarted, Mask last) {
    past_count_ = select(restarted, T(0.0), past_count_ + T(1.0));
    const Mask arrived = last & (!restarted);
    time_ = select(arrived, end_, time_ + h_);
    const Mask moving = h_ > T(0.0);
    if (!all(moving)) {
      for (int i = 0; i < system_.size(); ++i) {
        x1()[i] = select(moving, x1()[i], x()[i]);
        f1()[i] = select(moving, f1()[i], f()[i]);
      }
    }
    head_ = (head_ + 1) % kRing;
    for (int i = 0; i < system_.stiff_count(); ++i) decay_[i] = decay1_[i];
    for (int g = 0; g < system_.guard_count(); ++g) guard_[g] = guard1_[g];
    trigger_ = trigger1_;
  }

  void finish() {
    const auto lanes = static_cast<std::size_t>(kLanes);
    results_.final_state.resize(static_cast<std::size_t>(system_.size()) * lanes);
    if constexpr (requires { system_.get_largest_loop_error(); }) {
      for (int lane = 0; lane < kLanes; ++lane) {
        results_.loop_error.push_back(get_lane(system_.get_largest_loop_error(), lane));
      }
    }
    for (int i = 0; i < system_.size(); ++i) {
      for (int lane = 0; lane < kLanes; ++lane) {
        results_.final_state[static_cast<std::size_t>(i) * lanes + static_cast<std::size_t>(lane)] =
            get_lane(x()[i], lane);
      }
    }
  }

  T* x() { return x_ring_[static_cast<std::size_t>(head_)].data(); }
  T* f() { return f_ring_[static_cast<std::size_t>(head_)].data(); }
  T* x1() { return x_ring_[static_cast<std::size_t>((head_ + 1) % kRing)].data(); }
  T* f1() { return f_ring_[static_cast<std::size_t>((head_ + 1) % kRing)].data(); }
  AdamsHistory<T> get_past() const {
    AdamsHistory<T> past;
    for (int j = 0; j < 3; ++j) {
      const auto at = static_cast<std::size_t>((head_ + kRing - 1 - j) % kRing);
      past.x[static_cast<std::size_t>(j)] = x_ring_[at].data();
      past.f[static_cast<std::size_t>(j)] = f_ring_[at].data();
    }
    return past;
  }

  System& system_;
  StepOptions options_;
  SamplePlan plan_;
  LaneResults results_;
  // Ring of the last step ends: the current one at head_, the next after it, the past before it.
  static constexpr int kRing = 5;
  std::array<Vector, kRing> x_ring_{}, f_ring_{};
  int head_ = 0;
  Vector other_, other_f_;
  std::array<T, kMaxStiff> decay_{}, decay1_{};
  StiffWeights<T> weights_;
  StepScratch<T, N> scratch_;
  std::array<T, kMaxGuards> guard_{}, guard1_{}, side_{};
  T time_, end_, h_, past_count_, past_step_, step_count_, max_steps_, next_sample_, trigger_,
      trigger1_, triggered_;
  std::vector<T> channel_;
  std::size_t history_row_ = 0;  // numbers per history sample
};

}  // namespace strut
