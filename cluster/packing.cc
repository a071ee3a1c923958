#include "cluster/packing.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace strut {
namespace {

/// Bound on the arrays of a sweep with gaps everywhere.
constexpr std::size_t kMaxRanges = 16;

/// Closes the narrowest gaps until at most `max_ranges` ranges remain; fewer if gaps are equal.
void close_gaps(std::vector<ShardRange>& ranges, std::size_t max_ranges) {
  if (ranges.size() <= max_ranges) return;
  std::vector<std::int64_t> gaps;
  for (std::size_t i = 1; i < ranges.size(); ++i) {
    gaps.push_back(ranges[i].first - ranges[i - 1].end);
  }
  auto cut = gaps.begin() + static_cast<std::ptrdiff_t>(max_ranges - 1);
  std::nth_element(gaps.begin(), cut, gaps.end(), std::greater<>());
  const std::int64_t narrow = *cut;
  std::vector<ShardRange> wide = {ranges.front()};
  for (std::size_t i = 1; i < ranges.size(); ++i) {
    if (ranges[i].first - wide.back().end > narrow) {
      wide.push_back(ranges[i]);
    } else {
      wide.back().end = ranges[i].end;
    }
  }
  ranges = std::move(wide);
}

std::int64_t count_tasks(const std::vector<ShardRange>& ranges, std::int64_t shards_per_task) {
  std::int64_t tasks = 0;
  for (const ShardRange& range : ranges) tasks += PackedArray{range, shards_per_task}.tasks();
  return tasks;
}

}  // namespace

std::vector<ShardRange> list_missing(std::int64_t shards, const std::vector<std::int64_t>& present,
                                     std::vector<ShardRange> taken) {
  for (const std::int64_t shard : present) taken.push_back({shard, shard + 1});
  std::sort(taken.begin(), taken.end(),
            [](const ShardRange& a, const ShardRange& b) { return a.first < b.first; });
  std::vector<ShardRange> missing;
  std::int64_t next = 0;
  for (const ShardRange& range : taken) {
    if (range.first > next) missing.push_back({next, std::min(range.first, shards)});
    next = std::max(next, range.end);
    if (next >= shards) break;
  }
  if (next < shards) missing.push_back({next, shards});
  return missing;
}

ShardRange PackedArray::get_task(std::int64_t task) const {
  const std::int64_t first = shards.first + task * shards_per_task;
  return {first, std::min(first + shards_per_task, shards.end)};
}

std::vector<PackedArray> pack_shards(std::vector<ShardRange> missing,
                                     const PackingRequest& request) {
  close_gaps(missing, std::min(kMaxRanges, static_cast<std::size_t>(request.limits.tasks)));
  const double fit = std::floor(request.task_seconds / request.shard_seconds);
  std::int64_t shards_per_task = std::max<std::int64_t>(1, std::llround(std::min(fit, 1e15)));
  std::int64_t total = 0;
  for (const ShardRange& range : missing) total += range.count();
  shards_per_task = std::min(shards_per_task, std::max<std::int64_t>(total, 1));
  while (count_tasks(missing, shards_per_task) > request.limits.tasks && shards_per_task < total) {
    shards_per_task = std::min(total, std::max(shards_per_task + 1, shards_per_task * 5 / 4));
  }
  std::vector<PackedArray> arrays;
  const std::int64_t max_shards = std::min(request.limits.array_tasks, total) * shards_per_task;
  for (const ShardRange& range : missing) {
    for (std::int64_t first = range.first; first < range.end; first += max_shards) {
      arrays.push_back({{first, std::min(range.end, first + max_shards)}, shards_per_task});
    }
  }
  return arrays;
}

}  // namespace strut
