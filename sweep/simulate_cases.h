// Simulates cases of a plan into rows of a shard, including failures and retries.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "io/store/shard.h"
#include "sweep/batch_simulator.h"
#include "sweep/plan.h"

namespace strut {

/// Lists the statuses of a case: "0 done, 1 diverged, ..."
std::string describe_case_status();

/// The last retry with a smaller step that may mend this failure; each divides the step by 4.
/// 0: none can.
int get_last_attempt(std::int32_t status);

/// Time spent in each part [s].
struct SimulationSeconds {
  double prepare = 0.0, integrate = 0.0, retry = 0.0;

  double total() const { return prepare + integrate + retry; }
  SimulationSeconds& operator+=(const SimulationSeconds& other);
};

/// Simulator of one thread; not thread-safe.
class CaseSimulator {
 public:
  /// Both arguments must outlive the simulator.
  CaseSimulator(const Plan& plan, const Kernel& kernel);

  /// Number of cases that fill one batch of lanes.
  std::size_t batch_size() const { return batches_.batch_size(); }

  /// Simulates `cases` (ids) into the rows from `first_row` on. A case that fails in lanes is
  /// retried at once (attempt 1 of `retry`). A case's row depends neither on the other cases nor on
  /// how they are grouped. Returns false, with incomplete rows, if `stop` turned true meanwhile.
  bool simulate(std::span<const std::int64_t> cases, ShardRows& rows, std::size_t first_row,
                const std::atomic<bool>& stop);

  /// Simulates one case in plain double, with the request's step divided by 4^attempt throughout
  /// and contact events located.
  void retry(std::int64_t case_id, int attempt, ShardRows& rows, std::size_t row);

  const SimulationSeconds& seconds() const { return seconds_; }

 private:
  void start_row(std::int64_t case_id, ShardRows& rows, std::size_t row) const;
  std::vector<ReadyCase> prepare(std::span<const std::int64_t> cases, ShardRows& rows,
                                 std::size_t first_row);
  void record(const LaneResults& results, int lane, ShardRows& rows, std::size_t row) const;

  const Plan& plan_;
  BatchSimulator batches_;
  SimulationSeconds seconds_;
};

}  // namespace strut
