// Is what a sweep folder holds exactly what its plan asked for?
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "model/kernel/simulation.h"
#include "sweep/folder.h"

namespace strut {

struct VerifyOptions {
  std::int64_t sample = 0;  // cases to simulate again
  std::uint64_t seed = 1;   // of their choice
  /// Instruction set to simulate with where a shard's own is not to be had here: results then agree
  /// to 1e-9 only.
  const Kernel* fallback = nullptr;
};

struct VerifyReport {
  std::int64_t cases = 0;            // of the plan
  std::int64_t missing = 0;          // of the plan, in no sound shard
  std::int64_t twice = 0;            // in two places
  std::int64_t foreign = 0;          // that the plan does not ask for, or not there, or not so
  std::int64_t shards = 0;           // read
  std::vector<std::string> damaged;  // "file: what"
  std::string data_digest;
  std::int64_t resimulated = 0;
  std::int64_t compared_by_tolerance = 0;  // of those, on another instruction set than the shard's
  std::vector<std::string> differing;      // cases that came out differently

  bool ok() const {
    return missing == 0 && twice == 0 && foreign == 0 && damaged.empty() && differing.empty();
  }
};

/// Reads every byte of every shard and overlay: checksums, schema, plan, case ids, parameters and
/// layers. Then simulates a sample again, bit for bit. `progress` is called with the cases read so
/// far. Throws EnvironmentError where the folder cannot be listed.
VerifyReport verify_sweep(const SweepFolder& folder, const Plan& plan, const VerifyOptions& options,
                          const std::function<void(std::int64_t)>& progress);

}  // namespace strut
