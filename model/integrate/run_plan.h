// What to integrate, what to record, and what comes back.
#pragma once

#include <vector>

namespace strut {

enum class Stepper { kRk4, kAbm4 };

enum class RunStatus : int {
  kDone = 0,
  kDiverged = 1,     // a state is no longer finite, or faster than any car
  kOutOfTravel = 2,  // a corner left the travel its loops were closed over
  kStalled = 3,      // steps cut short by contact events, one upon the other, get nowhere
};

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
};

/// History samples of a plan, the one at t = 0 included.
inline int count_samples(const SamplePlan& plan) {
  return plan.interval > 0.0 ? static_cast<int>(plan.duration / plan.interval + 1e-9) + 1 : 0;
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
  std::vector<double> history;       // [sample][channel][lane]
  std::vector<double> final_state;   // [component][lane]
  std::vector<double> loop_error;    // m per lane, largest over the run (systems with loops)
  int sample_count = 0;
  long derivative_count = 0;  // right-hand sides evaluated (all lanes at once)
  long event_count = 0;       // steps shortened by a guard, summed over lanes
};

}  // namespace strut
