// Runs that recorded inputs drive, simulated in many variants, as many at once as the processor has
// SIMD lanes, in the steps that their models need (model/longest_step.h).
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

/// A run's rig with its unknowns set, and the corrections of its inputs.
struct DrivenVariant {
  RigSpec rig;
  std::array<InputCorrection, kMaxRigInputs> inputs;  // in the order of ModelInfo::inputs
};

/// Sets those of `values` that belong to run number `index`, except biases. Throws InputError where
/// a value is out of its range.
DrivenVariant make_variant(const MeasuredRun& run, std::size_t index,
                           const std::vector<Unknown>& unknowns, const std::vector<double>& values);

/// Sampling of a simulated run: at the run's own times where they are evenly spaced, else finely
/// enough to interpolate.
struct DrivenSampling {
  double interval = 0.0, step = 0.0;  // s; whole steps lie between samples
  double fine_step = 0.0;             // s, where a joint crosses its play; divides `step`
  bool even = false;
};

/// The sampling that the run's nominal setup needs.
DrivenSampling choose_sampling(const MeasuredRun& run, const LinearizeOptions& options);

/// A simulation to be made of a run. It must not outlive the run.
struct DrivenTask {
  const MeasuredRun* run = nullptr;
  std::size_t run_index = 0;
  std::string failure;  // reason for which it is infeasible; empty: it is feasible
  DrivenVariant variant;
  DrivenSampling sampling;

  DrivenTask(const MeasuredRun& measured, std::size_t index, const std::vector<Unknown>& unknowns,
             const std::vector<double>& values, const LinearizeOptions& options);
};

/// A simulation, read at the run's times.
class DrivenResult {
 public:
  explicit DrivenResult(std::string failure) : failure_(std::move(failure)) {}
  DrivenResult(const DrivenTask& task, const LaneResults& results, int lane);

  const std::string& failure() const { return failure_; }
  /// Interpolates where the samples are not at the run's times. `column` counts the channels that
  /// were asked for. Needs a result without failure.
  double read(std::size_t time, std::size_t column) const;

 private:
  std::string failure_;
  const MeasuredRun* run_ = nullptr;
  DrivenSampling sampling_;
  std::vector<std::vector<double>> history_;  // [column][sample]
};

/// Simulates each task and passes its result, of `channels` of the rig, to `take`, once and from
/// any thread, with the task's number. A task's result depends on no other task. Histories are
/// long, so none outlives its call.
void simulate_tasks(const std::vector<DrivenTask>& tasks, const std::vector<int>& channels,
                    int threads, const std::function<void(std::size_t, const DrivenResult&)>& take);

}  // namespace strut
