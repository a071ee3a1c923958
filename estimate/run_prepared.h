// Prepared cases through the simulation, in lockstep lanes or by CVODE: what compares runs with
// each other starts here.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "model/kernel/simulation.h"

namespace strut {

/// One simulation among the lanes that ran with it.
struct LaneRun {
  std::shared_ptr<const LaneResults> results;
  int lane = 0;

  RunStatus status() const {
    return static_cast<RunStatus>(results->status[static_cast<std::size_t>(lane)]);
  }
  /// A car channel of a history sample, of a plan that records all.
  double get(std::size_t sample, std::size_t channel) const {
    const auto lanes = static_cast<std::size_t>(results->lanes);
    return results
        ->history[(sample * CarChannel::kCount + channel) * lanes + static_cast<std::size_t>(lane)];
  }
  /// The history of a car channel that the plan records.
  std::vector<double> get_series(int channel) const;
};

/// All runs, in the cases' order, on some threads; no result depends on how many. Always in lanes,
/// even alone: lanes agree with each other to the bit, with plain double only to 1e-9, which a
/// difference would magnify. Runs that fail say so in their status.
std::vector<LaneRun> run_prepared(const std::vector<PreparedCase>& cases,
                                  const SolverOptions& integrate, const SamplePlan& plan,
                                  int threads = 1);

}  // namespace strut
