// Running a sweep: worker threads simulate, one writer thread publishes whole shards.
//
//   shards to do -> [claim] -> batches -> workers -> compressed shard -> bounded queue -> writer
//
// Killed at any moment, the folder holds whole shards and leftovers that the next run removes.
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "io/store/claims.h"
#include "sweep/folder.h"
#include "sweep/simulate_cases.h"

namespace strut {

struct RunOptions {
  const Kernel* kernel = nullptr;
  int threads = 1;
  std::int64_t first_shard = 0;
  std::int64_t end_shard = -1;  // -1: to the plan's end
  /// The same, resolved.
  std::int64_t find_end_shard(const Plan& plan) const {
    return end_shard < 0 ? plan.shard_count() : end_shard;
  }
  /// Once true, no further shard is begun; those in hand are finished.
  const std::atomic<bool>* drain = nullptr;
  bool retry_failed = false;  // also what failed, with smaller steps, into overlay shards
  ClaimOptions claims;
  /// Attributes of every shard; runner, times and counts are added.
  std::vector<std::pair<std::string, std::string>> provenance;
};

/// The progress of a run; read by other threads while it lasts.
struct RunProgress {
  std::atomic<std::int64_t> cases{0};      // of the shards asked for
  std::atomic<std::int64_t> present{0};    // done before this run began
  std::atomic<std::int64_t> simulated{0};  // by this run, shards in flight included
  std::atomic<std::int64_t> written{0};    // by this run, in published shards
  std::atomic<std::int64_t> elsewhere{0};  // that another runner finished meanwhile
  std::atomic<std::int64_t> failed{0};     // of `written`
  std::atomic<std::int64_t> retried{0};    // failed cases that were tried again
};

struct RunSummary {
  bool stopped = false;
  std::int64_t shards_written = 0, retries_written = 0;
  std::int64_t duplicates = 0;  // shards that another runner had published first
  std::int64_t mended = 0, still_failing = 0;
  std::int64_t failed = 0;         // cases without a result in the shards asked for, after this run
  std::vector<std::string> notes;  // for the user: what was moved aside and why
  /// Shards that are there but cannot be read, and why; their cases are in no count of failures.
  std::map<std::int64_t, std::string> damaged;
  SimulationSeconds simulation;        // summed over threads
  double compress = 0.0, write = 0.0;  // s; write: image and disk, by the writer
  std::uint64_t bytes = 0;
};

/// Does what is missing of the shards asked for. The threads share one shard and go on to the
/// next together, so that few are unfinished at any moment. Once `halt` is true (set by anybody) it
/// drops those, publishes what is whole and returns. Throws EnvironmentError, `halt` set, where
/// the folder cannot be written; what was published before stays valid.
RunSummary run_sweep(const SweepFolder& folder, const Plan& plan, const RunOptions& options,
                     RunProgress& progress, std::atomic<bool>& halt);

}  // namespace strut
