// Gives the workers of a runner the missing shards, batch by batch.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/store/claims.h"
#include "io/store/shard.h"
#include "sweep/folder.h"
#include "sweep/run.h"

namespace strut {

/// A shard in progress. Workers fill disjoint rows.
struct ShardJob {
  std::int64_t shard = 0;
  std::vector<std::int64_t> cases;
  ShardRows rows;
  std::atomic<std::size_t> remaining{0};  // cases without a result yet
  std::atomic<double> seconds{0.0};       // simulation time, summed over threads
};

struct Batch {
  std::shared_ptr<ShardJob> job;
  std::size_t first_row = 0, count = 0;

  std::span<const std::int64_t> cases() const {
    return std::span(job->cases).subspan(first_row, count);
  }
};

class ShardSource {
 public:
  /// Finds the shards of `options` that are missing; moves those that do not match the plan to
  /// quarantine, to be simulated again. The arguments must outlive the source.
  ShardSource(const SweepFolder& folder, const Plan& plan, const RunOptions& options,
              Claims& claims, RunProgress& progress);

  /// The files moved to quarantine, and why.
  const std::vector<std::string>& notes() const { return notes_; }

  /// Returns up to `size` cases to simulate. Waits while other runners hold all remaining shards.
  /// Returns nothing once none remains, `halt` is true, or the next shard would have to be started
  /// while the run drains.
  std::optional<Batch> next(std::size_t size, const std::atomic<bool>& halt);

 private:
  enum class Taken { kJob, kNoneNow, kNoneLeft };

  void scan(std::int64_t first, std::int64_t end);
  Taken open_job();
  bool take(std::int64_t shard);
  std::shared_ptr<ShardJob> make_job(std::int64_t shard) const;

  const SweepFolder& folder_;
  const Plan& plan_;
  const std::atomic<bool>* drain_;
  Claims& claims_;
  RunProgress& progress_;
  const ShardSchema schema_;
  std::vector<std::string> notes_;

  std::mutex mutex_;                   // guards all below
  std::vector<std::int64_t> missing_;  // those before next_ were taken
  std::size_t next_ = 0;
  std::vector<std::int64_t> elsewhere_;  // claimed by other runners at the last poll
  std::chrono::steady_clock::time_point next_poll_;
  std::shared_ptr<ShardJob> job_;
  std::size_t next_row_ = 0;
};

}  // namespace strut
