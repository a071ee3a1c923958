// Verifies that a sweep folder holds exactly the results of its plan.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "model/kernel/simulation.h"
#include "sweep/folder.h"

namespace strut {

struct VerifyOptions {
  std::int64_t sample = 0;  // number of cases to simulate again
  std::uint64_t seed = 1;   // seed of the random choice of these cases
  /// Kernel for shards whose own instruction set this machine lacks. Its results are compared to
  /// `tolerance`, relative or, below 1, absolute, instead of bit for bit.
  const Kernel* fallback = nullptr;
  double tolerance = 1e-9;
};

struct VerifyReport {
  std::int64_t cases = 0;            // in the plan
  std::int64_t missing = 0;          // cases of the plan that no valid shard holds
  std::int64_t misplaced = 0;        // rows of cases that belong elsewhere in the plan
  std::int64_t foreign = 0;          // rows that do not match the plan
  std::int64_t shards = 0;           // shards read
  std::int64_t failed = 0;           // valid rows of cases that failed, which is no damage
  std::vector<std::string> damaged;  // "file: error"
  std::string data_digest;
  std::int64_t resimulated = 0;
  std::int64_t compared_by_tolerance = 0;  // resimulated cases of another instruction set
  std::vector<std::string> differing;      // resimulated cases with other results

  bool ok() const {
    return missing == 0 && misplaced == 0 && foreign == 0 && damaged.empty() && differing.empty();
  }
};

/// Reads every byte of every shard and overlay and checks checksums, schema, plan, case ids,
/// parameters and strata. Then simulates a sample of the cases again and compares the results.
/// `progress` is called with the number of cases read so far. Throws EnvironmentError if the folder
/// cannot be listed.
VerifyReport verify_sweep(const SweepFolder& folder, const Plan& plan, const VerifyOptions& options,
                          const std::function<void(std::int64_t)>& progress);

}  // namespace strut
