// The progress of a sweep, from its folder alone.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "io/store/claims.h"
#include "io/store/data_digest.h"
#include "sweep/folder.h"

namespace strut {

struct SweepStatus {
  std::int64_t cases = 0;    // of the plan
  std::int64_t done = 0;     // with a result
  std::int64_t failed = 0;   // simulated, without one
  std::int64_t untried = 0;  // of `failed`: what a smaller step may mend, and no resume has tried
  std::int64_t running = 0;  // in shards that a living runner claims
  std::int64_t left = 0;     // not simulated yet, `running` included
  std::int64_t shards = 0, shards_present = 0;
  std::int64_t duplicates = 0;  // shards that two runners made
  std::map<std::string, std::int64_t> failures;
  std::vector<ClaimInfo> claims;
  double rate = 0.0;          // cases a second, as the journal's last minute shows; 0: unknown
  double seconds_left = 0.0;  // at that rate; NaN: unknown
  std::uint64_t bytes = 0;
  double simulation_seconds = 0.0;
  std::vector<std::string> faults;  // files that are not the plan's shards
  DataDigest digest;                // of the cases simulated so far

  bool complete() const { return left == 0; }
};

/// Looks at the seal and the size of each shard, not at all of its bytes. A shard in which these
/// are wrong, or not those of the plan or the journal, is listed as a fault, and its cases count as
/// left. Throws EnvironmentError where the folder cannot be listed.
SweepStatus read_status(const SweepFolder& folder, const Plan& plan);

}  // namespace strut
