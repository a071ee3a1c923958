// Reading runs in tests.
#pragma once

#include "model/kernel/simulation.h"

namespace strut::test {

inline SamplePlan make_plan(double interval) {
  SamplePlan plan;
  plan.interval = interval;
  return plan;
}

/// A channel of a car's history.
inline double get_history(const LaneResults& r, int sample, int channel, int lane = 0) {
  const auto at = [](int i) { return static_cast<std::size_t>(i); };
  return r.history[(at(sample) * CarChannel::kCount + at(channel)) * at(r.lanes) + at(lane)];
}

}  // namespace strut::test
