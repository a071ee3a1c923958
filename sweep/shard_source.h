// Hands the shards that a runner has to do to its workers, batch by batch.
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

/// A shard in the making. Workers fill disjoint rows.
struct ShardJob {
  std::int64_t shard = 0;
  std::vector<std::int64_t> cases;
  ShardRows rows;
  std::atomic<std::size_t> left{0};  // cases without a result yet
  std::atomic<double> seconds{0.0};  // of simulation, summed over threads
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
  /// Shards of `options` that are not in the folder; those that are but cannot be the plan's are
  /// moved aside and done again. The arguments must outlive it.
  ShardSource(const SweepFolder& folder, const Plan& plan, const RunOptions& options,
              Claims& claims, RunProgress& progress);

  /// The files that were moved aside, and why.
  const std::vector<std::string>& notes() const { return notes_; }

  /// Up to `size` cases to simulate. Waits where all that is left is in other runners' hands.
  /// Empty: nothing is left, `halt` is true, or a shard would have to be begun while the run
  /// drains.
  std::optional<Batch> next(std::size_t size, const std::atomic<bool>& halt);

 private:
  enum class Taken { kJob, kNothingNow, kNothingLeft };

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

  std::mutex mutex_;                 // guards all below
  std::vector<std::int64_t> to_do_;  // from next_ on
  std::size_t next_ = 0;
  std::vector<std::int64_t> elsewhere_;  // in other runners' hands when last asked
  std::chrono::steady_clock::time_point ask_again_;
  std::shared_ptr<ShardJob> job_;
  std::size_t next_row_ = 0;
};

}  // namespace strut
