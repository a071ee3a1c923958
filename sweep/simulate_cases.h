// Some cases of a plan through the simulation into rows of a shard, failures and retries included.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/store/shard.h"
#include "sweep/plan.h"

namespace strut {

/// "0 done, 1 diverged, ..."
std::string describe_case_status();

/// Whether another try with a smaller step may mend a failure.
bool may_retry(std::int32_t status);

/// Retries divide the step by 4 each; the last one still allowed.
inline constexpr int kLastAttempt = 4;

/// Time spent, by part [s].
struct SimulationSeconds {
  double prepare = 0.0, integrate = 0.0, retry = 0.0;

  double total() const { return prepare + integrate + retry; }
  SimulationSeconds& operator+=(const SimulationSeconds& other);
};

/// One thread's simulator; not to be shared.
class CaseSimulator {
 public:
  /// Both must outlive it.
  CaseSimulator(const Plan& plan, const Kernel& kernel);

  /// Cases that are best simulated together.
  std::size_t batch_size() const;

  /// Simulates `cases` (ids) into the rows from `first_row` on. A case that fails in lanes is tried
  /// once more at once (attempt 1 of `retry`). A case's row does not depend on the others, nor on
  /// how they are grouped. Returns false, rows incomplete, where `stop` turned true on the way.
  bool simulate(std::span<const std::int64_t> cases, ShardRows& rows, std::size_t first_row,
                const std::atomic<bool>& stop);

  /// Simulates one case alone in plain double with the request's step divided by 4^attempt
  /// everywhere, contact events located.
  void retry(std::int64_t case_id, int attempt, ShardRows& rows, std::size_t row);

  const SimulationSeconds& seconds() const { return seconds_; }

 private:
  struct Ready {
    PreparedCase prepared;
    std::size_t row;
  };

  void start_row(std::int64_t case_id, ShardRows& rows, std::size_t row) const;
  std::optional<PreparedCase> prepare(std::int64_t case_id, ShardRows& rows, std::size_t row);
  std::vector<Ready> prepare_all(std::span<const std::int64_t> cases, ShardRows& rows,
                                 std::size_t first_row);
  std::size_t run_group(std::span<const Ready> ready, ShardRows& rows);
  void record(const LaneResults& results, int lane, ShardRows& rows, std::size_t row) const;

  const Plan& plan_;
  const Kernel& kernel_;
  const SamplePlan samples_;
  CasePreparer preparer_;
  SimulationSeconds seconds_;
};

}  // namespace strut
