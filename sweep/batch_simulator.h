// Cases in lanes: prepared together, run in groups, read through their sensors.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "model/kernel/simulation.h"

namespace strut {

/// Settings that all cases of a batch share.
struct BatchPlan {
  SolverOptions integrate;
  SamplePlan samples;
  double snapshot_offset = 0.0;  // m, of the snapshot's line behind the bump's center
  StartMethod start = StartMethod::kLanes;
};

/// A case that is ready to run, with its number in the caller's list.
struct ReadyCase {
  PreparedCase prepared;
  std::size_t number;
};

/// Simulator of one thread; not thread-safe. A case's result depends neither on the other cases nor
/// on how they are grouped.
class BatchSimulator {
 public:
  using MakeCase = std::function<Case(std::size_t number)>;
  using Fail = std::function<void(std::size_t number, RunStatus status, const std::string& reason)>;
  using Record = std::function<void(std::size_t number, const LaneResults& results, int lane)>;

  /// `kernel` must outlive the simulator.
  BatchSimulator(BatchPlan plan, const Kernel& kernel);

  const BatchPlan& plan() const { return plan_; }
  /// Number of cases that fill one batch of lanes.
  std::size_t batch_size() const;

  /// Assembles the cases 0 .. count - 1 and finds their starts. Returns those that can run, in
  /// order; calls `fail` for the others.
  std::vector<ReadyCase> prepare(std::size_t count, const MakeCase& make_case, const Fail& fail);

  /// Runs the first of `ready` together with as many of its successors as may share lanes with it,
  /// and calls `record` for each; returns their number.
  std::size_t run_group(std::span<const ReadyCase> ready, const Record& record) const;

  /// Runs a case in plain double with other options, or by CVODE.
  LaneResults run_alone(const PreparedCase& c, const IntegrateOptions& options) const;

 private:
  std::vector<ReadyCase> keep_started(std::vector<ReadyCase> assembled, const Fail& fail) const;

  const BatchPlan plan_;
  const Kernel& kernel_;
  CasePreparer preparer_;
};

}  // namespace strut
