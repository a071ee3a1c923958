// Runs a sweep: worker threads simulate, one writer thread publishes whole shards.
//
//   missing shards -> [claim] -> batches -> workers -> compressed shard -> bounded queue -> writer
//
// If a run is killed at any moment, the folder holds whole shards and temporary files that the next
// run removes.
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
  /// `end_shard`, resolved.
  std::int64_t find_end_shard(const Plan& plan) const {
    return end_shard < 0 ? plan.shard_count() : end_shard;
  }
  /// Once true, no further shard is started; those in progress are finished.
  const std::atomic<bool>* drain = nullptr;
  bool retry_failed = false;  // retry failed cases with smaller steps, into overlay shards
  ClaimOptions claims;
  /// Attributes of every shard; runner, times and counts are added.
  std::vector<std::pair<std::string, std::string>> provenance;
};

/// Progress of a run, in cases; other threads may read it meanwhile.
struct RunProgress {
  std::atomic<std::int64_t> cases{0};      // all cases of the requested shards
  std::atomic<std::int64_t> present{0};    // done before this run started
  std::atomic<std::int64_t> simulated{0};  // by this run, including shards in progress
  std::atomic<std::int64_t> written{0};    // by this run, in published shards
  std::atomic<std::int64_t> elsewhere{0};  // finished by other runners meanwhile
  std::atomic<std::int64_t> failed{0};     // among `written`
  std::atomic<std::int64_t> retried{0};    // failed cases that were retried
};

struct RunSummary {
  bool stopped = false;
  std::int64_t shards_written = 0, retries_written = 0;
  std::int64_t duplicates = 0;  // shards that another runner published first
  std::int64_t mended = 0, still_failing = 0;
  std::int64_t failed = 0;         // cases without a result in the requested shards, after this run
  std::vector<std::string> notes;  // for the user: files moved to quarantine, and why
  /// Unreadable shards with the error; their cases are in no count of failures.
  std::map<std::int64_t, std::string> damaged;
  SimulationSeconds simulation;        // summed over threads
  double compress = 0.0, write = 0.0;  // s; write: file image and disk, by the writer thread
  std::uint64_t bytes = 0;
};

/// Simulates the requested shards that are missing. The threads share one shard and proceed to the
/// next together, so that few are incomplete at any moment. Once `halt` is true (any thread may set
/// it), drops incomplete shards, publishes complete ones and returns. Throws EnvironmentError, with
/// `halt` set, if the folder cannot be written; shards published before stay valid.
RunSummary run_sweep(const SweepFolder& folder, const Plan& plan, const RunOptions& options,
                     RunProgress& progress, std::atomic<bool>& halt);

}  // namespace strut
