// Reads the progress of a sweep from its folder.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "io/store/claims.h"
#include "io/store/data_digest.h"
#include "sweep/folder.h"

namespace strut {

/// Failed cases with the same status.
struct FailureCount {
  std::int64_t cases = 0;
  std::int64_t first_case = -1;  // id of the first in the plan's order; -1: its shard is damaged
  std::string first_reason;      // why it failed, in words
};

struct SweepStatus {
  std::int64_t cases = 0;      // in the plan
  std::int64_t done = 0;       // with a result
  std::int64_t failed = 0;     // simulated, without a result
  std::int64_t untried = 0;    // failed cases that a smaller step may mend, not yet retried
  std::int64_t running = 0;    // in shards claimed by a living runner
  std::int64_t simulated = 0;  // among `running`, at the runners' last heartbeats
  std::int64_t left = 0;       // not in a shard yet, including `running`
  std::int64_t shards = 0, shards_present = 0;
  std::int64_t duplicates = 0;                   // shards that two runners simulated
  std::map<std::string, FailureCount> failures;  // by the name of the run's status
  std::vector<ClaimInfo> claims;
  double rate = 0.0;          // cases/s over the journal's last minute; 0: unknown
  double seconds_left = 0.0;  // s, for the cases not simulated, at `rate`; NaN: unknown
  std::uint64_t bytes = 0;
  double simulation_seconds = 0.0;
  std::vector<std::string> faults;  // errors of files that do not match the plan
  DataDigest digest;                // digest of the cases simulated so far

  bool complete() const { return left == 0; }
};

/// Checks the seal and the size of each shard, not all of its bytes. A shard whose seal or size is
/// wrong, or does not match the plan or the journal, is listed in `faults`, and its cases count as
/// left. Throws EnvironmentError if the folder cannot be listed.
SweepStatus read_status(const SweepFolder& folder, const Plan& plan);

}  // namespace strut
