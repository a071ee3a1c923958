// Runs that recorded inputs drive, simulated in many variants, as many at once as the processor has
// SIMD lanes, in steps that feel the stroke which a worn strut has lost.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "estimate/linearize_options.h"
#include "estimate/measured_run.h"
#include "estimate/unknown.h"
#include "model/integrate/run_plan.h"
#include "model/rig/rigs.h"

namespace strut {

/// A run's rig with its unknowns set, and what its inputs are multiplied by.
struct DrivenVariant {
  RigSpec rig;
  std::array<double, kMaxRigInputs> gain{};  // in the order of ModelInfo::inputs
};

/// With those of `values` that belong to run number `index`; biases are no part of it. Throws
/// InputError where a value is out of its range.
DrivenVariant make_variant(const MeasuredRun& run, std::size_t index,
                           const std::vector<Unknown>& unknowns, const std::vector<double>& values);

/// The sampling of a run: its own times where they are even, else finely enough to interpolate.
struct DrivenSampling {
  double interval = 0.0, step = 0.0;  // s; whole steps lie between samples
  bool even = false;
};

/// As its nominal setup needs.
DrivenSampling choose_sampling(const MeasuredRun& run, const LinearizeOptions& options);

/// A simulation of a run to be made; it must not outlive the run.
struct DrivenTask {
  const MeasuredRun* run = nullptr;
  std::string failure;  // why it cannot be; empty: it can
  DrivenVariant variant;
  DrivenSampling sampling;

  DrivenTask(const MeasuredRun& of, std::size_t index, const std::vector<Unknown>& unknowns,
             const std::vector<double>& values, const LinearizeOptions& options);
};

/// A simulation, read at the run's times.
class DrivenResult {
 public:
  explicit DrivenResult(std::string failure) : failure_(std::move(failure)) {}
  DrivenResult(const DrivenTask& of, const LaneResults& results, int lane);

  const std::string& failure() const { return failure_; }
  /// NaN where the simulation cannot be interpolated.
  double read(std::size_t time, std::size_t channel) const;

 private:
  void read_sensors(const RigSpec& rig);

  std::string failure_;
  const MeasuredRun* run_ = nullptr;
  DrivenSampling sampling_;
  std::size_t channels_ = 0, count_ = 0;
  std::vector<double> history_;  // [sample][channel]
};

/// Simulates each task and hands its result to `take`, once and from any thread, with the task's
/// number. What a task gives depends on no other task. Histories are long: none outlives its call.
void simulate_tasks(const std::vector<DrivenTask>& tasks, int threads,
                    const std::function<void(std::size_t, const DrivenResult&)>& take);

}  // namespace strut
