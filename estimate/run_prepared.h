// Simulates prepared cases in lockstep lanes or by CVODE, for differences between runs.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "model/kernel/simulation.h"

namespace strut {

/// One simulation among the lanes that ran together.
struct LaneRun {
  std::shared_ptr<const LaneResults> results;
  int lane = 0;

  RunStatus status() const { return results->get_status(lane); }
  /// A car channel of a history sample; for plans that record all channels.
  double get(std::size_t sample, std::size_t channel) const {
    return results->get_sample(static_cast<int>(sample), static_cast<int>(channel), lane);
  }
  /// The history of a car channel; for plans that record it.
  std::vector<double> get_series(int channel) const;
};

/// Runs all cases and returns them in the same order; results do not depend on the number of
/// threads. A single case also runs in a lane: lanes agree with each other bit by bit, with double
/// only to 1e-9, which a difference would magnify. Steps are halved where the effects of a case
/// need it (PreparedCase::longest_step). A failed run reports its status.
std::vector<LaneRun> run_prepared(const std::vector<PreparedCase>& cases,
                                  const SolverOptions& integrate, const SamplePlan& plan,
                                  int threads = 1);

}  // namespace strut
