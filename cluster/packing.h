// Distributes shards over tasks.
#pragma once

#include <cstdint>
#include <vector>

#include "cluster/dispatcher.h"

namespace strut {

/// Shards [first, end).
struct ShardRange {
  std::int64_t first = 0, end = 0;

  std::int64_t count() const { return end - first; }
  bool operator==(const ShardRange&) const = default;
};

/// Returns [0, shards) without `present` (ascending) and without `taken`, as ascending ranges. The
/// cost grows with the number of present shards and ranges, not with `shards`.
std::vector<ShardRange> list_missing(std::int64_t shards, const std::vector<std::int64_t>& present,
                                     std::vector<ShardRange> taken = {});

/// Tasks of equal size: task t covers [first + t * shards_per_task, ...) up to the end of the
/// range.
struct PackedArray {
  ShardRange shards;
  std::int64_t shards_per_task = 1;

  std::int64_t tasks() const { return (shards.count() + shards_per_task - 1) / shards_per_task; }
  ShardRange get_task(std::int64_t task) const;
  bool operator==(const PackedArray&) const = default;
};

/// Bound on the tasks of one submission, whose records are read one by one.
constexpr std::int64_t kMaxTasks = 1'000'000;

struct PackingRequest {
  double shard_seconds = 1.0;   // wall clock of one shard on the threads of one task
  double task_seconds = 600.0;  // target
  SiteLimits limits;
};

/// Returns arrays that cover the ranges within the limits, with larger tasks if there would be too
/// many. To limit the number of arrays, gaps between ranges may be covered too: tasks skip shards
/// that exist. A task may exceed the site's time limit: it then stops in time and is queued again.
std::vector<PackedArray> pack_shards(std::vector<ShardRange> missing,
                                     const PackingRequest& request);

}  // namespace strut
