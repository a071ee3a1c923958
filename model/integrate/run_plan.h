// Plan of an integration: steps and samples; results of all lanes.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "base/math/lanes.h"
#include "model/integrate/run_status.h"

namespace strut {

enum class Stepper { kRk4, kAbm4 };

struct StepOptions {
  Stepper stepper = Stepper::kRk4;
  double step = 1e-3;          // s
  bool locate_events = true;   // end steps at contact events
  double coarse_step = 0.0;    // s, where the system needs no fine step; 0: `step` everywhere
  bool refines_events = true;  // whether events are located to rounding, not to the dense output

  bool operator==(const StepOptions&) const = default;
};

struct SamplePlan {
  double duration = 3.0;  // s
  /// Durations by lane where they differ, at most `duration` [s]; their samples then end with NaN.
  std::vector<double> lane_durations = {};
  double interval = 0.0;  // s between history samples from t = 0; 0: no history
  bool snapshot = true;
  bool until_snapshot = false;  // whether a run without history ends with its snapshot
  int channel_count = 0;
  int parts = 1;  // samples per interval; every parts-th equals that of parts = 1 bit for bit
  std::vector<int> recorded = {};  // channels of the history, in this order; empty: all

  int recorded_count() const {
    return recorded.empty() ? channel_count : static_cast<int>(recorded.size());
  }
};

/// Number of history samples of a plan, including the one at t = 0.
inline int count_samples(const SamplePlan& plan) {
  if (!(plan.interval > 0.0)) return 0;
  const double intervals = plan.duration / plan.interval;
  const int whole = plan.parts * static_cast<int>(intervals + 1e-9);
  return std::max(whole, static_cast<int>(intervals * plan.parts + 1e-9)) + 1;
}

/// Time of a sample [s]; samples are numbered from 0.
template <class T>
T calc_sample_time(const SamplePlan& plan, const T& sample) {
  const double parts = plan.parts;
  const T whole = floor((sample + T(0.5)) * T(1.0 / parts));
  return whole * T(plan.interval) + (sample - whole * T(parts)) * T(plan.interval / parts);
}

/// Speed above which an integration counts as diverged [m/s].
inline constexpr double kDivergenceSpeed = 500.0;

/// Results of all lanes. The lane is the fastest index of every array; the accessors know the
/// layout.
struct LaneResults {
  int lanes = 1;
  std::vector<int> status;           // RunStatus per lane
  std::vector<double> failure_time;  // s; duration where done
  std::vector<double> event_time;    // s; NaN where the trigger never changed sign
  std::vector<double> snapshot;      // [channel][lane]
  std::vector<double> history;       // [sample][recorded channel][lane]
  std::vector<int> recorded;         // channels of the history as in the plan; empty: all
  std::vector<double> final_state;   // [component][lane]
  std::vector<double> loop_error;    // m per lane, maximum over the run (systems with loops)
  /// Derivatives of event_time, snapshot and history, of a run that was differentiated: one for
  /// each direction, per unit of its parameter.
  std::vector<LaneResults> slopes = {};
  int sample_count = 0;
  long derivative_count = 0;  // right-hand sides evaluated (all lanes at once)
  long event_count = 0;       // steps shortened by a guard, summed over lanes

  RunStatus get_status(int lane = 0) const { return static_cast<RunStatus>(status[at(lane)]); }
  bool is_done(int lane = 0) const { return get_status(lane) == RunStatus::kDone; }
  double get_failure_time(int lane = 0) const { return failure_time[at(lane)]; }

  /// Whether the trigger changed sign.
  bool has_snapshot(int lane = 0) const { return std::isfinite(event_time[at(lane)]); }
  double get_event_time(int lane = 0) const { return event_time[at(lane)]; }
  double get_snapshot(int channel, int lane = 0) const {
    return snapshot[find_snapshot(channel, lane)];
  }
  std::size_t find_snapshot(int channel, int lane = 0) const {
    return at(channel) * at(lanes) + at(lane);
  }

  /// Number of channels in the history; 0 without samples.
  int recorded_count() const {
    return sample_count > 0 ? static_cast<int>(history.size() / (at(sample_count) * at(lanes))) : 0;
  }
  /// `column` counts the recorded channels; where all are recorded it is the channel.
  double get_sample(int sample, int column, int lane = 0) const {
    return history[find_sample(sample, column, lane)];
  }
  std::size_t find_sample(int sample, int column, int lane = 0) const {
    return (at(sample) * at(recorded_count()) + at(column)) * at(lanes) + at(lane);
  }
  /// All samples of one recorded channel.
  std::vector<double> get_history(int column, int lane = 0) const {
    std::vector<double> samples;
    samples.reserve(at(sample_count));
    for (int i = 0; i < sample_count; ++i) samples.push_back(get_sample(i, column, lane));
    return samples;
  }

  double get_final_state(int component, int lane = 0) const {
    return final_state[at(component) * at(lanes) + at(lane)];
  }

 private:
  static constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }
};

}  // namespace strut
