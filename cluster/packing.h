// Which task does which shards.
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

/// [0, shards) without `present` (ascending) and without `taken`, as ranges in ascending order:
/// nothing is enumerated but what is present.
std::vector<ShardRange> list_missing(std::int64_t shards, const std::vector<std::int64_t>& present,
                                     std::vector<ShardRange> taken = {});

/// Tasks of equal size: task t does [first + t * shards_a_task, ...) up to the range's end.
struct PackedArray {
  ShardRange shards;
  std::int64_t shards_a_task = 1;

  std::int64_t tasks() const { return (shards.count() + shards_a_task - 1) / shards_a_task; }
  ShardRange get_task(std::int64_t task) const;
  bool operator==(const PackedArray&) const = default;
};

/// Of one submission: the tasks' own records are read one by one.
constexpr std::int64_t kMostTasks = 1'000'000;

struct PackingRequest {
  double shard_seconds = 1.0;   // wall clock of one shard on one task's threads
  double task_seconds = 600.0;  // aimed at
  SiteLimits limits;
};

/// Arrays that cover the ranges, within the limits: larger tasks where there would be too many.
/// What lies between ranges may be covered, too, where arrays would be too many: tasks pass over
/// shards that are there. A task may then be longer than the site's wall clock: it stops in time
/// and is queued again.
std::vector<PackedArray> pack_shards(std::vector<ShardRange> missing,
                                     const PackingRequest& request);

}  // namespace strut
