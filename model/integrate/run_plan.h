// What to integrate, what to record, and what comes back.
#pragma once

#include <algorithm>
#include <vector>

#include "base/math/lanes.h"
#include "model/integrate/run_status.h"

namespace strut {

enum class Stepper { kRk4, kAbm4 };

struct StepOptions {
  Stepper stepper = Stepper::kRk4;
  double step = 1e-3;         // s
  bool locate_events = true;  // end steps at contact events
  double coarse_step = 0.0;   // s, where the system says that nothing happens; 0: `step` everywhere
};

struct SamplePlan {
  double duration = 3.0;  // s
  double interval = 0.0;  // s between history samples from t = 0; 0: no history
  bool snapshot = true;
  int channel_count = 0;
  int parts = 1;  // samples an interval; every parts-th is, bit for bit, that of a plan with one
  std::vector<int> recorded = {};  // channels of the history, in this order; empty: all

  int recorded_count() const {
    return recorded.empty() ? channel_count : static_cast<int>(recorded.size());
  }
};

/// History samples of a plan, the one at t = 0 included.
inline int count_samples(const SamplePlan& plan) {
  if (!(plan.interval > 0.0)) return 0;
  const double intervals = plan.duration / plan.interval;
  const int whole = plan.parts * static_cast<int>(intervals + 1e-9);
  return std::max(whole, static_cast<int>(intervals * plan.parts + 1e-9)) + 1;
}

/// Time of a sample by its number [s].
template <class T>
T calc_sample_time(const SamplePlan& plan, const T& sample) {
  const double parts = plan.parts;
  const T whole = floor((sample + T(0.5)) * T(1.0 / parts));
  return whole * T(plan.interval) + (sample - whole * T(parts)) * T(plan.interval / parts);
}

/// Speeds beyond this are an unstable integration, not a car or a rig [m/s].
inline constexpr double kAbsurdSpeed = 500.0;

/// Results of all lanes; arrays of doubles with the lane as the fastest index.
struct LaneResults {
  int lanes = 1;
  std::vector<int> status;           // RunStatus per lane
  std::vector<double> failure_time;  // s; duration where done
  std::vector<double> event_time;    // s; NaN where the trigger never changed sign
  std::vector<double> snapshot;      // [channel][lane]
  std::vector<double> history;       // [sample][recorded channel][lane]
  std::vector<int> recorded;         // as the plan's
  std::vector<double> final_state;   // [component][lane]
  std::vector<double> loop_error;    // m per lane, largest over the run (systems with loops)
  int sample_count = 0;
  long derivative_count = 0;  // right-hand sides evaluated (all lanes at once)
  long event_count = 0;       // steps shortened by a guard, summed over lanes
};

}  // namespace strut
