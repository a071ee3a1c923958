// Some cases of a plan through the simulation into rows of a shard, failures and retries included.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "io/shard.h"
#include "sweep/plan.h"

namespace strut {

/// How a case ended; RunStatus and what can happen before and after the integration.
enum class CaseStatus : int {
  kDone = 0,
  kDiverged = 1,       // a state is no longer finite, or faster than any car
  kOutOfTravel = 2,    // a corner left the travel its loops were closed over
  kNoEquilibrium = 3,  // loops cannot be closed, springs cannot carry the car, no trim
  kNoEvent = 4,        // the car never met the snapshot's line
};

inline constexpr int kCaseStatusCount = 5;
/// "done", "diverged", ...: the words of status, journal and documentation.
const char* get_case_status_name(CaseStatus status);

/// Time spent, by part [s].
struct SimulationSeconds {
  double prepare = 0.0, integrate = 0.0, retry = 0.0;
};

/// One thread's simulator; not to be shared.
class CaseSimulator {
 public:
  /// `first_attempt` 0: in lanes as the request says. k > 0: in plain double with the request's step
  /// divided by 4^k, everywhere and with contact events located.
  CaseSimulator(const Plan& plan, const Kernel& kernel);

  /// Simulates `cases` (ids) into the rows from `first_row` on. A case that fails in lanes is tried
  /// once more at once, alone, in plain double with a quarter of the step. A case's row does not
  /// depend on the others.
  void simulate(std::span<const std::int64_t> cases, ShardRows& rows, std::size_t first_row);

  /// One case alone; `attempt` >= 1 as above.
  void retry(std::int64_t case_id, int attempt, ShardRows& rows, std::size_t row);

  const SimulationSeconds& seconds() const { return seconds_; }

 private:
  void record(const PreparedCase& prepared, const LaneResults& results, int lane, int attempt,
              ShardRows& rows, std::size_t row) const;
  void start_row(std::int64_t case_id, ShardRows& rows, std::size_t row) const;
  void fail(ShardRows& rows, std::size_t row, CaseStatus status, double time,
            const std::string& reason) const;

  const Plan& plan_;
  const Kernel& kernel_;
  SamplePlan samples_;
  CasePreparer preparer_;
  SimulationSeconds seconds_;
};

}  // namespace strut
